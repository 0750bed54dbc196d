#include "all_effects.hpp"

namespace detp::sim {
namespace {

Finding find_bias(const EffectSample& sample) {
  const CountedRatio& ratio = sample.crossings().discs;
  return {.value = ratio.value, .standard_error = ratio.standard_error, .apply = [ratio](Workload& workload) {
            workload.hit_ratio *= ratio.value;
          }};
}

double bias_of_numbers(const Workload& workload) { return workload.hit_ratio; }

}  // namespace

constinit const Effect directional_bias{
    .name = "directional bias",
    .evidence = "share of the rays through a small sphere that hit its disc, over that of isotropic rays",
    .threshold = {Threshold::Side::apart, 1, 0.1},
    .find = find_bias,
    .of_numbers = bias_of_numbers};

}  // namespace detp::sim
