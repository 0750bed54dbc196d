#pragma once

#include <cstdint>

namespace detp::support {

/// Number of calls of operator new so far, on this thread. Builds with sanitizers do not count them: 0.
[[nodiscard]] std::uint64_t allocations();

}  // namespace detp::support
