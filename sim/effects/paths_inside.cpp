#include "paths_inside.hpp"

#include <cmath>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/ray_box.hpp"

namespace detp::sim {

PathsInside paths_inside(const Problem& problem, std::span<const std::size_t> rays, const Box& box, double disc_radius,
                         const std::stop_token& stop) {
  StopCheck check(stop, "measuring the rays");
  const Box grown{box.low - disc_radius, box.high + disc_radius};
  PathsInside paths;
  const double each = 1 / static_cast<double>(rays.size());
  const double unit = glm::length(grown.size());
  double squares = 0;  // of lengths in units of the diagonal, so that they neither overflow nor vanish
  for_each_checked(rays, check, [&](std::size_t ray) {
    const RayInterval inside = ClippedRay(problem.rays()[ray]).inside(grown);
    if (inside.empty()) return;
    const double length = inside.to - inside.from;
    paths.share += each;
    paths.length += each * length;
    squares += each * (length / unit) * (length / unit);
  });
  const double mean = paths.length / unit;
  paths.length_error = unit * std::sqrt(std::max(0.0, squares - mean * mean) * each);
  return paths;
}

}  // namespace detp::sim
