#pragma once

#include <cstdint>
#include <string_view>

namespace detp::sim {

/// How far some work came: done of so many units.
struct Progress {
  std::uint64_t done = 0;
  std::uint64_t of = 0;
  std::string_view unit = "rays";  ///< of static storage
};

}  // namespace detp::sim
