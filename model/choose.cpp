#include "choose.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "best_ratio.hpp"
#include "box_tree_rule.hpp"
#include "disc_index.hpp"
#include "extrapolation.hpp"
#include "predict.hpp"
#include "sphere_tree.hpp"

namespace detp::model {
namespace {

/// Keeps the fastest of the candidates it is shown that stay within the limits.
class Fastest {
 public:
  Fastest(const Workload& workload, const UnitCosts& costs, const SearchLimits& limits)
      : workload_(workload), costs_(costs), limits_(limits) {}

  void consider(const Candidate& candidate) { consider(candidate, predict(workload_, candidate)); }

  void consider(const Candidate& candidate, const Counts<double>& counts) {
    if (counts.references > limits_.most_references) return;
    const CostBreakdown time = price(counts, costs_, candidate.technique);
    if (!best_ || time.total() < best_->time.total()) best_ = Ranked{candidate, counts, time, {}};
  }

  [[nodiscard]] std::optional<Ranked> best() && {
    if (best_) best_->extrapolated = extrapolations(workload_, best_->candidate);
    return std::move(best_);
  }

 private:
  const Workload& workload_;
  const UnitCosts& costs_;
  const SearchLimits& limits_;
  std::optional<Ranked> best_;
};

std::optional<Ranked> best_cache(Technique technique, const Workload& workload, const UnitCosts& costs) {
  if (workload.disc_radius >= workload.sphere_radius) return std::nullopt;
  const BestRatio best = best_ratio_and_stop(workload, costs);
  if (best.spheres == 0) return std::nullopt;
  return assess(workload, {technique, SphereCacheParameters{best.ratio, best.spheres, SampleOrder::lebesgue}}, costs);
}

std::optional<Ranked> best_cells(const Workload& workload, const UnitCosts& costs, const SearchLimits& limits) {
  Fastest fastest(workload, costs, limits);
  for (int depth = 0; depth <= std::min(limits.most_depth, 16) && !limits.stop.stop_requested(); ++depth)
    fastest.consider({Technique::cell_spheres, CellSpheresParameters{depth}});
  return std::move(fastest).best();
}

std::optional<Ranked> best_octree(const Workload& workload, const UnitCosts& costs, const SearchLimits& limits) {
  Fastest fastest(workload, costs, limits);
  int depth = 0;
  for (const Counts<double>& counts : octree_counts_by_depth(workload, {limits.most_depth}))
    fastest.consider({Technique::octree, OctreeParameters{depth++}}, counts);
  return std::move(fastest).best();
}

std::optional<Ranked> best_grid(const Workload& workload, const UnitCosts& costs, const SearchLimits& limits) {
  Fastest fastest(workload, costs, limits);
  for (int cells = 1;
       cells <= 1 << 16 && index_cells(workload, cells).count() <= limits.most_cells && !limits.stop.stop_requested();
       cells = std::max(cells + 1, static_cast<int>(1.1 * cells)))
    fastest.consider({Technique::grid, GridParameters{cells}});
  return std::move(fastest).best();
}

}  // namespace

Ranked assess(const Workload& workload, const Candidate& candidate, const UnitCosts& costs) {
  check(costs);
  const Counts<double> counts = predict(workload, candidate);
  return {candidate, counts, price(counts, costs, candidate.technique), extrapolations(workload, candidate)};
}

SphereTreeParameters best_sphere_tree(const Workload& workload, const UnitCosts& costs, std::optional<int> fan_out,
                                      std::optional<int> leaf) {
  constexpr std::array fan_outs{2, 3, 4, 6, 8, 12, 16};
  constexpr std::array leaves{1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 64, 128, 256, 1024};
  const auto only = [](const std::optional<int>& given, std::span<const int> all) {
    return given ? std::vector<int>{*given} : std::vector<int>(all.begin(), all.end());
  };
  SphereTreeParameters best;
  double least = std::numeric_limits<double>::infinity();
  for (const int f : only(fan_out, fan_outs))
    for (const int l : only(leaf, leaves)) {
      const double time = price(sphere_tree_counts(workload, {f, l}), costs).total();
      if (time < least) {
        least = time;
        best = {f, l};
      }
    }
  return best;
}

SphereTreeParameters best_tree(const Workload& workload, const UnitCosts& costs, const TreeWish& wish) {
  if (wish.bounds == Bounds::spheres) return best_sphere_tree(workload, costs, wish.fan_out, wish.leaf);
  check(workload);
  const SphereTreeParameters rule = box_tree_rule(workload);
  return {wish.fan_out.value_or(rule.fan_out), wish.leaf.value_or(rule.leaf), Bounds::boxes};
}

std::optional<Ranked> best_of(Technique technique, const Workload& workload, const UnitCosts& costs,
                              const SearchLimits& limits) {
  check(workload);
  switch (technique) {
    case Technique::brute_force:
      return assess(workload, {Technique::brute_force, BruteForceParameters{}}, costs);
    case Technique::sphere_cache:
    case Technique::sphere_cache_published:
      return best_cache(technique, workload, costs);
    case Technique::cell_spheres:
      return best_cells(workload, costs, limits);
    case Technique::sphere_tree:
      return assess(workload, {Technique::sphere_tree, best_tree(workload, costs)}, costs);
    case Technique::octree:
      return best_octree(workload, costs, limits);
    case Technique::grid:
      return best_grid(workload, costs, limits);
    case Technique::bsp:
    case Technique::bvh:
    case Technique::photon_map:
      return std::nullopt;
  }
  throw std::logic_error("a technique that cannot be chosen");
}

std::vector<Ranked> rank(const Workload& workload, const UnitCosts& costs, const SearchLimits& limits) {
  std::vector<Ranked> ranking;
  for (const Technique technique : all_techniques) {
    if (!ranking.empty() && limits.stop.stop_requested()) break;
    if (finds_all_hits(technique) && has_closed_form(technique))
      if (auto best = best_of(technique, workload, costs, limits)) ranking.push_back(std::move(*best));
  }
  std::stable_sort(ranking.begin(), ranking.end(),
                   [](const Ranked& a, const Ranked& b) { return a.time.total() < b.time.total(); });
  return ranking;
}

}  // namespace detp::model
