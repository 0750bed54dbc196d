#include "all_effects.hpp"
#include "crossings.hpp"

/// Three ratios of numbers of rays: around the samples over uniform rays, close to them over around them, and through their
/// discs over close to them.
///
/// Samples that are hidden from the light by others, or lie inside closed objects, are crossed by fewer rays than the
/// space around them. Where rays end on the samples' surfaces and start from them, they are crossed by more.
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

Finding times_hits(const CountedRatio& ratio) {
  return {.value = ratio.value,
          .standard_error = ratio.standard_error,
          .apply = [times = ratio.value](Workload& workload) { workload.hit_ratio *= times; }};
}

Finding find_occlusion(const EffectSample& sample) { return times_hits(sample.crossings().near); }
Finding find_bias(const EffectSample& sample) { return times_hits(sample.crossings().discs); }

double density_of_numbers(const Workload& workload) { return workload.ray_density; }
double occlusion_of_numbers(const Workload&) { return 1; }
double bias_of_numbers(const Workload& workload) { return workload.hit_ratio; }

}  // namespace

constinit const Effect uneven_rays{.name = "uneven rays",
                                   .evidence = "rays that cross spheres around samples, over uniform rays",
                                   .threshold = {Threshold::Side::apart, 1, 0.1},
                                   .find = find_density,
                                   .of_numbers = density_of_numbers};

constinit const Effect occlusion{.name = "occlusion",
                                 .evidence = "density of rays close to samples, over that around them",
                                 .threshold = {Threshold::Side::apart, 1, 0.1},
                                 .find = find_occlusion,
                                 .of_numbers = occlusion_of_numbers};

constinit const Effect directional_bias{
    .name = "directional bias",
    .evidence = "share of the rays through a small sphere that hit its disc, over that of isotropic rays",
    .threshold = {Threshold::Side::apart, 1, 0.1},
    .find = find_bias,
    .of_numbers = bias_of_numbers};

}  // namespace detp::sim
