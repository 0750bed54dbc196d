#include "all_effects.hpp"
#include "crossings.hpp"

/// Samples that are hidden from the light by others, or lie inside closed objects, are crossed by fewer rays than the
/// space around them. Where rays end on the samples' surfaces and start from them, they are crossed by more.
namespace detp::sim {
namespace {

Finding find_occlusion(const EffectSample& sample) {
  const CountedRatio& near = sample.crossings().near;
  return {.value = near.value, .standard_error = near.standard_error, .apply = [near](Workload& workload) {
            workload.hit_ratio *= near.value;
          }};
}

double occlusion_of_numbers(const Workload&) { return 1; }

}  // namespace

constinit const Effect occlusion{.name = "occlusion",
                                 .evidence = "density of rays close to samples, over that around them",
                                 .threshold = {Threshold::Side::apart, 1, 0.1},
                                 .find = find_occlusion,
                                 .of_numbers = occlusion_of_numbers};

}  // namespace detp::sim
