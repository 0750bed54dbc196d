#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "detp/model/closed_form/closed_form.hpp"
#include "detp/model/closed_form/fastest.hpp"
#include "detp/model/closed_form/reasons.hpp"
#include "detp/model/hierarchy/box_tree.hpp"

namespace detp::model {
namespace {

Counts<double> counts_of_box_tree(const Valid<Workload>& workload, const Valid<Candidate>& candidate, Engine engine) {
  const auto& tree = checked_parameters<BoxTreeParameters>(candidate);
  return box_tree_counts(workload, tree, engine);
}

/// Calls time_with for leaves from 4 to 256: all powers of two, or few of them if another technique's time is known. These
/// start at a usual leaf, which is doubled as long as the time is at most 4 % longer than the least (it goes up and down
/// among few samples), and then halved in the same way if doubling did not pay. Few samples get all leaves: where the last leaf
/// would hold one of them, the time goes up and down by more. In 4000 random workloads the best tree found took no longer than that
/// of all powers of two.
template <class TimeWith>
void search_leaves(double samples, const SearchLimits& limits, const TimeWith& time_with) {
  constexpr std::array leaves{4, 8, 16, 32, 64, 128, 256};
  constexpr std::ptrdiff_t usual = 3;
  constexpr double look_ahead = 1.04;
  constexpr double few_samples = 512;
  if (limits.fastest == HUGE_VAL || samples <= few_samples) {
    for (const int leaf : leaves) time_with(leaf);
    return;
  }
  // Leaves that hold all samples are all the same.
  const auto whole = std::find_if(leaves.begin(), leaves.end(), [&](int leaf) { return leaf >= samples; });
  const std::ptrdiff_t last = std::min(whole - leaves.begin(), std::ssize(leaves) - 1);
  const std::ptrdiff_t first = std::min(usual, last);
  const double usual_time = time_with(leaves[first]);
  double least = usual_time;
  const auto walk = [&](std::ptrdiff_t step) {
    for (std::ptrdiff_t i = first + step; i >= 0 && i <= last; i += step) {
      const double time = time_with(leaves[i]);
      if (time > look_ahead * least) break;
      least = std::min(least, time);
    }
  };
  walk(1);
  if (least == usual_time) walk(-1);
}

/// Tries fan-outs of 4, 8 and 16 with each leaf of the search. They share the binary tree of the leaf.
std::optional<FoundParameters> best_box_tree(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                             const FixedParameters& fixed, const SearchLimits& limits) {
  SearchLimits any_size = limits;  // a box tree holds each disc once
  any_size.most_references = std::numeric_limits<double>::infinity();
  Fastest<BoxTreeParameters> fastest(costs, Technique::box_tree, any_size);
  std::vector<int> fan_outs{8, 4, 16};
  if (const auto fan_out = fixed.value<std::int64_t>("fan-out")) fan_outs = {static_cast<int>(*fan_out)};
  Counts<double> best_counts;
  /// Returns the least time with this leaf.
  const auto consider = [&](int leaf) {
    double least = std::numeric_limits<double>::infinity();
    if (fastest.best() && limits.stop.stop_requested()) return least;
    BoxTreeShapes shapes(workload, leaf, limits.engine);
    for (const int fan_out : fan_outs) {
      const Counts<double> counts = shapes.counts(fan_out);
      const double before = fastest.least();
      const double time = fastest.consider({fan_out, leaf}, counts);
      if (time < before) best_counts = counts;
      least = std::min(least, time);
    }
    return least;
  };
  if (const auto fixed_leaf = fixed.value<std::int64_t>("leaf"))
    consider(static_cast<int>(*fixed_leaf));
  else
    search_leaves(workload.samples, limits, consider);
  best_counts.loaded = workload.rays;
  if (some_rays_end(workload)) best_counts.segments = workload.rays;
  return FoundParameters{*fastest.best(), best_counts};
}

void uncounted_box_tree(const Valid<Workload>& workload, const Parameters& parameters, Reasons& reasons) {
  const auto& tree = std::get<BoxTreeParameters>(parameters);
  uncounted_scene(workload, reasons);
  reasons.range("samples", workload.samples, 0x1p10, 0x1p20);
  reasons.range("d over sample distance", workload.disc_radius / sample_distance(workload), 0x1p-10, 0x1p3);
  reasons.range("d over the scene's side", workload.disc_radius / scene_side(workload), 0, 0.16);
  reasons.range("fan-out", tree.fan_out, 2, 16);
  reasons.range("leaf", tree.leaf, 1, 256);
}

}  // namespace

TechniqueModel model_box_tree() { return {counts_of_box_tree, best_box_tree, uncounted_box_tree}; }

}  // namespace detp::model
