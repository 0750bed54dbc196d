#include <array>
#include <cmath>
#include <span>

#include "detp/model/closed_form/closed_form.hpp"
#include "detp/model/closed_form/fastest.hpp"
#include "detp/model/closed_form/reasons.hpp"
#include "detp/model/hierarchy/sphere_tree.hpp"

namespace detp::model {
namespace {

/// Factor by which the time with the first parameters tried may exceed that with the best ones. The largest in 1100 random
/// workloads: 2.6.
constexpr double good_sphere_tree_excess = 3;

std::optional<FoundParameters> best_sphere_tree(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                                const FixedParameters& fixed, const SearchLimits& limits) {
  constexpr std::array<std::int64_t, 7> fan_outs{2, 3, 4, 6, 8, 12, 16};
  constexpr std::array<std::int64_t, 14> leaves{1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 64, 128, 256, 1024};
  const auto only = [&](std::string_view name, std::span<const std::int64_t> all) {
    const auto value = fixed.value<std::int64_t>(name);
    return value ? std::vector<std::int64_t>{*value} : std::vector<std::int64_t>(all.begin(), all.end());
  };
  Fastest<SphereTreeParameters> fastest(costs, Technique::sphere_tree, limits);
  const auto consider = [&](const SphereTreeParameters& tree) {
    fastest.consider(tree, sphere_tree_counts(workload, tree));
  };
  if (limits.fastest < HUGE_VAL && fixed.values.empty()) {
    for (const int leaf : {12, 64}) {
      consider({6, leaf});
      if (fastest.least() > good_sphere_tree_excess * limits.fastest) break;
    }
    if (fastest.least() > good_sphere_tree_excess * limits.fastest) return not_tuned(*fastest.best());
  }
  for (const std::int64_t fan_out : only("fan-out", fan_outs))
    for (const std::int64_t leaf : only("leaf", leaves)) consider({static_cast<int>(fan_out), static_cast<int>(leaf)});
  return tuned(fastest.best());
}

void uncounted_sphere_tree(const Valid<Workload>& workload, const Parameters& parameters, Reasons& reasons) {
  const auto& tree = std::get<SphereTreeParameters>(parameters);
  uncounted_scene(workload, reasons);
  range_of_samples(workload, reasons);
  reasons.range("fan-out", tree.fan_out, 4, 8);
  reasons.range("leaf", tree.leaf, 4, 16);
}

}  // namespace

TechniqueModel model_sphere_tree() {
  return {predicted<SphereTreeParameters, sphere_tree_counts>, best_sphere_tree, uncounted_sphere_tree};
}

}  // namespace detp::model
