#include "all_effects.hpp"
#include "crossings.hpp"

namespace detp::sim {
namespace {

Finding find_density(const EffectSample& sample) {
  const Crossings& crossings = sample.crossings();
  if (!(crossings.spheres > 0)) return {.value = 1};
  const double density = crossings.spheres / sample.uniform().sphere(crossings.radius);
  return {
      .value = density, .standard_error = density * crossings.spheres_error, .apply = [crossings](Workload& workload) {
        workload.ray_density = crossings.spheres / uniform_rays(workload).sphere(crossings.radius);
      }};
}

double density_of_numbers(const Workload& workload) { return workload.ray_density; }

}  // namespace

constinit const Effect uneven_rays{.name = "uneven rays",
                                   .evidence = "rays that cross spheres around samples, over uniform rays",
                                   .threshold = {Threshold::Side::apart, 1, 0.1},
                                   .find = find_density,
                                   .of_numbers = density_of_numbers};

}  // namespace detp::sim
