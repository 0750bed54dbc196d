#include "workload.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "checks.hpp"

namespace detp {

void check(const Workload& workload) {
  require_count("number of rays", workload.rays, 1, 1e18);
  require_count("number of samples", workload.samples, 1, 1e18);
  require_positive("disc radius", workload.disc_radius);
  require_positive("sphere radius", workload.sphere_radius);
  for (const double side : workload.box) require_non_negative("side of the sample box", side);
  if (!(workload.dimension >= 1 && workload.dimension <= 3))
    throw std::invalid_argument(fmt::format("sample dimension must be from 1 to 3 (got {})", workload.dimension));
  require_non_negative("sample extent", workload.sample_extent);
  require_non_negative("sample distance", workload.sample_distance);
  require_non_negative("path length", workload.path_length);
  require_positive("longest side of the sample box", scene_side(workload));
  if (workload.sample_extent > 1e270)
    throw std::invalid_argument(
        fmt::format("sample extent must be at most 1e270, or it overflows (got {})", workload.sample_extent));
  for (const double length : {workload.sphere_radius, scene_side(workload)})
    if (length < 1e-90 || length > 1e90)
      throw std::invalid_argument(fmt::format(
          "sphere radius and sample box must lie between 1e-90 and 1e90, or their volumes overflow (got {})", length));
}

double sample_extent(const Workload& workload) {
  if (workload.sample_extent > 0) return workload.sample_extent;
  // A flat box has no volume. Its sides count as at least 1e-6 of the longest, so that no density becomes infinite.
  const double sliver = 1e-6 * scene_side(workload);
  std::array<double, 3> side = workload.box;
  for (double& length : side) length = std::max(length, sliver);
  const double volume = side[0] * side[1] * side[2];
  const double area = 2 * (side[0] * side[1] + side[1] * side[2] + side[2] * side[0]);
  const double weight = std::clamp(workload.dimension - 2, 0.0, 1.0);
  return std::pow(volume, weight) * std::pow(area, 1 - weight);
}

double sample_distance(const Workload& workload) {
  if (workload.sample_distance > 0) return workload.sample_distance;
  const long double share = static_cast<long double>(sample_extent(workload)) / workload.samples;
  return static_cast<double>(std::pow(share, 1.0L / workload.dimension));
}

double scene_side(const Workload& workload) { return *std::max_element(workload.box.begin(), workload.box.end()); }

double enclosing_radius(double side, double disc_radius) { return side * (std::sqrt(3.0) / 2) + disc_radius; }

Workload cube_workload(double rays, double samples, double disc_radius, double side, double dimension) {
  return {.rays = rays,
          .samples = samples,
          .disc_radius = disc_radius,
          .sphere_radius = enclosing_radius(side, disc_radius),
          .box = {side, side, side},
          .dimension = dimension};
}

}  // namespace detp
