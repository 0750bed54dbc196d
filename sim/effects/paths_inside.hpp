#pragma once

#include <span>
#include <stop_token>

#include "detp/sim/search/problem.hpp"

namespace detp::sim {

/// The parts of some rays inside a box.
struct PathsInside {
  double share = 0;         ///< of the rays that have a part inside
  double length = 0;        ///< mean length of the part inside, over all rays
  double length_error = 0;  ///< standard error of the length
};

/// Measures the rays with these numbers in the box grown by the disc radius. Throws Stopped if a stop was requested.
[[nodiscard]] PathsInside paths_inside(const Problem& problem, std::span<const std::size_t> rays, const Box& box,
                                       double disc_radius, const std::stop_token& stop = {});

}  // namespace detp::sim
