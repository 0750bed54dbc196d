#pragma once

#include <cstdint>
#include <string_view>

namespace detp::sim {

/// Progress of some work: `done` of `of` units.
struct Progress {
  std::uint64_t done = 0;
  std::uint64_t of = 0;
  std::string_view unit = "rays";  ///< refers to a string of static storage
};

}  // namespace detp::sim
