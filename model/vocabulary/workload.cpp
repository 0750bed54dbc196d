#include "workload.hpp"

#include <algorithm>
#include <cmath>

#include "checks.hpp"

namespace detp {

void check(const Workload& workload) {
  require_count("number of rays", workload.rays, 1, 1e18);
  require_count("number of samples", workload.samples, 1, 1e18);
  require_positive("disc radius", workload.disc_radius);
  require_positive("sphere radius", workload.sphere_radius);
  for (const double side : workload.box) require_non_negative("side of the sample box", side);
  require_finite("sample dimension", workload.dimension);
  if (workload.dimension < 1 || workload.dimension > 3) require_count("sample dimension", workload.dimension, 1, 3);
  require_non_negative("sample distance", workload.sample_distance);
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
