#pragma once

#include <optional>

#include "detp/sim/base/memory.hpp"

namespace detp::support {

/// Sets the memory limit, and restores the default.
struct MemoryLimit {
  explicit MemoryLimit(double bytes) { sim::set_memory_limit(bytes); }
  ~MemoryLimit() { sim::set_memory_limit(std::nullopt); }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;
};

}  // namespace detp::support
