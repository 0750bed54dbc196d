#include "all_effects.hpp"

namespace detp::sim {
namespace {

Finding find_facing(const EffectSample& sample) {
  return {.value = sample.problem.front_facing() ? 1.0 : 0.0,
          .apply = [](Workload& workload) { workload.front_facing = true; }};
}

double facing_of_numbers(const Workload& workload) { return workload.front_facing ? 1 : 0; }

}  // namespace

constinit const Effect one_face{.name = "facing",
                                .evidence = "1 if only rays that arrive at a disc's front count",
                                .threshold = {Threshold::Side::above, 0.5, 0},
                                .is_input = true,
                                .find = find_facing,
                                .of_numbers = facing_of_numbers};

}  // namespace detp::sim
