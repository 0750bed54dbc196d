#include "all_effects.hpp"
#include "crossings.hpp"

namespace detp::sim {
namespace {

Finding find_density(const EffectSample& sample) {
  const Crossings& crossings = sample.crossings();
  const double crossed = crossings.around.value * sample.uniform().sphere(crossings.radius);
  return {.value = crossings.around.value,
          .standard_error = crossings.around.standard_error,
          .apply = [crossed, radius = crossings.radius](Workload& workload) {
            workload.ray_density = crossed / uniform_rays(workload).sphere(radius);
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
