#include "cell_spheres.hpp"

#include <algorithm>
#include <cmath>

#include "line_measure.hpp"

namespace detp::model {
namespace {

void require_level(int level) { require_count("level", level, 0, 300); }

double rays_in(const Workload& workload, int level) {
  const double ratio = std::min(1.0, cell_sphere_radius(workload, level) / workload.sphere_radius);
  return workload.rays * ratio * ratio;
}

}  // namespace

double cell_sphere_radius(const Workload& workload, int level) {
  check(workload);
  require_level(level);
  return enclosing_radius(std::ldexp(scene_side(workload), -level), workload.disc_radius);
}

double occupied_cell_spheres(double samples, int level) {
  require_count("number of samples", samples, 1, 1e18);
  require_level(level);
  if (level == 0) return 1;
  return std::ldexp(-std::expm1(samples * std::log1p(-std::ldexp(1.0, -3 * level))), 3 * level);
}

Counts<double> cell_sphere_counts(const Workload& workload, int levels) {
  check(workload);
  require_level(levels);
  Counts<double> counts{.sorted = workload.samples, .hits = expected_hits(workload)};
  double around = workload.rays;
  for (int level = 1; level <= levels; ++level) {
    const double spheres = occupied_cell_spheres(workload.samples, level);
    const double rays = rays_in(workload, level);
    counts.rebuilds += spheres;
    counts.sphere_tests += spheres * around;
    counts.copies += spheres * rays;
    around = rays;
  }
  counts.disc_tests = workload.samples * around;
  return counts;
}

}  // namespace detp::model
