#include "all_effects.hpp"

namespace detp::sim {

constinit const Effect few_rays{
    .name = "few rays",
    .evidence = "1 if there are fewer rays than discs",
    .threshold = {Threshold::Side::above, 0.5, 0},
    .find = [](const EffectSample& sample) -> Finding {
      return {.value = sample.problem.rays().size() < sample.problem.discs().size() ? 1.0 : 0.0};
    },
    .of_numbers = [](const Workload& workload) { return workload.rays < workload.samples ? 1.0 : 0.0; }};

}  // namespace detp::sim
