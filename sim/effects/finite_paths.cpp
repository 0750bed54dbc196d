#include <algorithm>
#include <numbers>

#include "all_effects.hpp"

namespace detp::sim {
namespace {

/// Mean length, inside the samples' box grown by d, of the lines of μ_ℓ through S₀: V / (π r₀²). (The mean chord of a
/// convex body is 4V/S; a line through S₀ hits the body with the probability S / (4π r₀²). Santaló, Integral Geometry.)
double length_of_lines(const UniformRays& rays) { return rays.space / (std::numbers::pi * rays.r0 * rays.r0); }

Finding find_paths(const EffectSample& sample) {
  if (!sample.problem.segments()) return {.value = 1};
  const PathsInside& paths = sample.paths();
  const double lines = length_of_lines(sample.uniform());
  return {.value = paths.length / lines,
          .standard_error = paths.length_error / lines,
          .apply = [length = paths.length](Workload& workload) {
            constexpr double shortest = 1e-9;  // over r₀; 0 would mean lines, but no ray may reach the box
            workload.path_length = std::max(length, shortest * workload.sphere_radius);
          }};
}

double paths_of_numbers(const Workload& workload) {
  return workload.path_length > 0 ? workload.path_length / length_of_lines(uniform_rays(workload)) : 1;
}

}  // namespace

constinit const Effect finite_paths{.name = "finite paths",
                                    .evidence = "mean length inside the samples' box, over that of lines through S0",
                                    .threshold = {Threshold::Side::apart, 1, 0.05},
                                    .find = find_paths,
                                    .of_numbers = paths_of_numbers};

}  // namespace detp::sim
