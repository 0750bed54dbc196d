#include "all_effects.hpp"

namespace detp::sim {
namespace {

Finding find_bias(const EffectSample& sample) {
  const Crossings& crossings = sample.crossings();
  if (!(crossings.discs > 0)) return {.value = 1};
  const UniformRays& uniform = sample.uniform();
  const double isotropic =
      uniform.disc(crossings.radius, sample.problem.front_facing()) / uniform.sphere(crossings.radius);
  const double ratio = crossings.discs / crossings.spheres / isotropic;
  return {.value = ratio, .standard_error = ratio * crossings.ratio_error, .apply = [ratio](Workload& workload) {
            workload.hit_ratio = ratio;
          }};
}

double bias_of_numbers(const Workload& workload) { return workload.hit_ratio; }

}  // namespace

constinit const Effect directional_bias{
    .name = "directional bias",
    .evidence = "share of the rays through a sphere that hit its disc, over that of isotropic rays",
    .threshold = {Threshold::Side::apart, 1, 0.1},
    .find = find_bias,
    .of_numbers = bias_of_numbers};

}  // namespace detp::sim
