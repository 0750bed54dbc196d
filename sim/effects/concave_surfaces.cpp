#include "all_effects.hpp"

namespace detp::sim {
namespace {

Finding find_concave_surfaces(const EffectSample& sample) {
  return sample.surface.self_shadow.value_or(Finding{});  // rays that are given are taken as they are
}

double concavity_of_numbers(const Workload&) { return 0; }

}  // namespace

constinit const Effect concave_surfaces{
    .name = "concave surfaces",
    .evidence = "hits gained if paths go on by 2d, less light through sheets, over hits; + 0.01",
    .threshold = {Threshold::Side::above, 0, 0},
    .find = find_concave_surfaces,
    .of_numbers = concavity_of_numbers};

}  // namespace detp::sim
