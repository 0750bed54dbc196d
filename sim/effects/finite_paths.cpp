#include <numbers>

#include "all_effects.hpp"
#include "paths_inside.hpp"

namespace detp::sim {
namespace {

/// Mean length, inside the samples' box grown by d, of the lines of μ_ℓ through S₀: V / (π r₀²). (The mean chord of a
/// convex body is 4V/S; a line through S₀ hits the body with the probability S / (4π r₀²). Santaló, Integral Geometry.)
double length_of_lines(double r0, double volume) { return volume / (std::numbers::pi * r0 * r0); }

double volume_of(const std::array<double, 3>& box, double d) {
  return (box[0] + 2 * d) * (box[1] + 2 * d) * (box[2] + 2 * d);
}

Finding find(const EffectSample& sample) {
  const Problem& problem = sample.problem;
  if (!problem.segments()) return {.value = 1};
  const double d = problem.radii().rms;
  const PathsInside paths = paths_inside(problem, sample.rays, problem.centres(), d, sample.stop);
  const glm::dvec3 size = problem.centres().size();
  const double lines = length_of_lines(problem.enclosing().radius, volume_of({size.x, size.y, size.z}, d));
  return {.value = paths.length / lines,
          .standard_error = paths.length_error / lines,
          .apply = [length = paths.length](Workload& workload) { workload.path_length = length; }};
}

double of_numbers(const Workload& workload) {
  if (!(workload.path_length > 0)) return 1;
  return workload.path_length / length_of_lines(workload.sphere_radius, volume_of(workload.box, workload.disc_radius));
}

}  // namespace

constinit const Effect finite_paths{.name = "finite paths",
                                    .evidence = "mean length inside the samples' box, over that of lines through S0",
                                    .threshold = {Threshold::Side::apart, 1, 0.05},
                                    .find = find,
                                    .of_numbers = of_numbers};

}  // namespace detp::sim
