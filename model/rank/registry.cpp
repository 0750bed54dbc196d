#include "registry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <span>

#include "detp/model/disc_index/disc_index.hpp"
#include "detp/model/hierarchy/box_tree.hpp"
#include "detp/model/hierarchy/cell_spheres.hpp"
#include "detp/model/hierarchy/sphere_tree.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/sphere_cache/rebuild_law.hpp"
#include "detp/model/sphere_cache/sphere_cache.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/model/vocabulary/ray_blocks.hpp"
#include "fastest.hpp"
#include "index_best.hpp"

namespace detp::model {
namespace {

/// Factors by which the time with the first parameters tried may exceed that with the best ones. The largest in 1100
/// random workloads: 1.35 for eight ratios (best_ratio.hpp), 2.6 for sphere trees, 1.33 for grids.
constexpr double good_ratio_excess = 1.5;
constexpr double good_sphere_tree_excess = 3;
constexpr double good_grid_excess = 1.5;

/// The candidate's parameters, valid because the candidate was checked.
template <class P>
Valid<P> checked_parameters(const Valid<Candidate>& candidate) {
  return Valid<P>(candidate, std::get<P>(candidate.parameters));
}

/// Calls a formula that takes the parameters of one technique, with those of the candidate.
template <class P, auto counts>
Counts<double> predicted(const Valid<Workload>& workload, const Valid<Candidate>& candidate, Engine) {
  return counts(workload, checked_parameters<P>(candidate));
}

/// As `predicted`, for a technique with a simd engine whose formula counts the lists and visits of one block of rays.
template <class P, auto counts>
Counts<double> in_blocks(const Valid<Workload>& workload, const Valid<Candidate>& candidate, Engine engine) {
  const auto& parameters = checked_parameters<P>(candidate);
  Counts<double> all = counts(workload, parameters);
  const RayBlocks blocks = ray_blocks(workload.rays, workload.samples, engine);
  if (blocks.count() == 1) return all;
  const auto of_block = [&](double rays) {
    Workload block = workload;
    block.rays = rays;
    return counts(Valid<Workload>(workload, block), parameters);
  };
  const Counts<double> full = of_block(blocks.size);
  all.culls = blocks.whole * full.culls;
  all.visits = blocks.whole * full.visits;
  if (blocks.last > 0) {
    const Counts<double> last = of_block(blocks.last);
    all.culls += last.culls;
    all.visits += last.visits;
  }
  return all;
}

Counts<double> counts_of_box_tree(const Valid<Workload>& workload, const Valid<Candidate>& candidate, Engine engine) {
  const auto& tree = checked_parameters<BoxTreeParameters>(candidate);
  return box_tree_counts(workload, tree, engine);
}

/// Plain density estimation on the tangent plane: each disc against each ray.
Counts<double> brute_force(const Valid<Workload>& workload, const BruteForceParameters&) {
  return {.visits = workload.samples, .disc_tests = workload.rays * workload.samples, .hits = expected_hits(workload)};
}

Counts<double> published_cache(const Valid<Workload>& workload, const SphereCacheParameters& parameters) {
  require_rebuild_law(parameters.order);
  return published::counts(workload, {parameters.ratio}, parameters.spheres);
}

/// A large disc has the spheres around its small neighbours made again. So all discs count as large as the largest: the
/// counts are an upper bound.
Workload as_large(Workload workload) {
  workload.disc_radius = largest_radius(workload);
  workload.radii.clear();
  return workload;
}

Counts<double> corrected_cache(const Valid<Workload>& workload, const Valid<SphereCacheParameters>& parameters) {
  if (workload.radii.empty()) return sphere_cache_counts(workload, parameters);
  Counts<double> counts = sphere_cache_counts(as_large(workload), parameters);
  counts.hits = expected_hits(workload);
  return counts;
}

Counts<double> octree(const Valid<Workload>& workload, const OctreeParameters& parameters) {
  return octree_counts(workload, parameters);
}

Counts<double> grid(const Valid<Workload>& workload, const GridParameters& parameters) {
  return grid_counts(workload, parameters);
}

template <class P>
std::optional<FoundParameters> tuned(const std::optional<P>& best) {
  return best ? std::optional(FoundParameters{*best}) : std::nullopt;
}

template <class P>
std::optional<FoundParameters> not_tuned(const P& good) {
  return FoundParameters{good, {}, false};
}

std::optional<FoundParameters> best_cache(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                          const FixedParameters& fixed, const SearchLimits& limits) {
  if (!workload.radii.empty()) return best_cache(as_large(workload), costs, fixed, limits);
  const auto ratio = fixed.value<double>("ratio");
  const auto spheres = fixed.value<std::int64_t>("spheres");
  // No sphere holds a disc.
  if (workload.disc_radius >= workload.sphere_radius)
    return FoundParameters{SphereCacheParameters{ratio.value_or(published_ratio), spheres.value_or(0)}};
  if (limits.fastest < HUGE_VAL && fixed.values.empty()) {
    const double others = limits.fastest - time_at_any_ratio(workload, costs);
    const BestRatio good = good_ratio_below(workload, costs, others);
    if (good.spheres > 0 && good.time > good_ratio_excess * others)
      return not_tuned(SphereCacheParameters{good.ratio, good.spheres});
  }
  const BestRatio best = ratio     ? best_stop(workload, costs, {*ratio})
                         : spheres ? best_ratio_for(workload, costs, *spheres)
                                   : best_ratio_and_stop(workload, costs);
  return FoundParameters{SphereCacheParameters{ratio.value_or(best.ratio), spheres.value_or(best.spheres)}};
}

std::optional<FoundParameters> best_cells(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                          const FixedParameters&, const SearchLimits& limits) {
  Fastest<CellSpheresParameters> fastest(costs, Technique::cell_spheres, limits);
  int depth = 0;
  for_each_cell_sphere_depth(workload, {std::min(limits.most_depth, 16)}, [&](const Counts<double>& counts) {
    fastest.consider({depth++}, counts);
    return !fastest.excludes(counts) && !limits.stop.stop_requested();
  });
  return tuned(fastest.best());
}

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

/// Calls time_with for leaves from 4 to 256: all powers of two, or few of them if another technique's time is known. These
/// start at a usual leaf, which is doubled as long as the time is at most 4 % longer than the least (it goes up and down
/// among few samples), and then halved in the same way if doubling did not pay. In 1400 random workloads the best tree found
/// takes at most 0.5 % longer than that of all powers of two.
template <class TimeWith>
void search_leaves(double samples, const SearchLimits& limits, const TimeWith& time_with) {
  constexpr std::array leaves{4, 8, 16, 32, 64, 128, 256};
  constexpr std::ptrdiff_t usual = 3;
  constexpr double look_ahead = 1.04;
  if (limits.fastest == HUGE_VAL) {
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

/// The best depth for top-down traversal, whatever the traversal is.
std::optional<FoundParameters> best_octree(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                           const FixedParameters&, const SearchLimits& limits) {
  const auto depth = best_octree_depth(workload, costs, limits);
  return depth ? std::optional(FoundParameters{OctreeParameters{*depth}}) : std::nullopt;
}

std::optional<FoundParameters> best_grid(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                         const FixedParameters&, const SearchLimits& limits) {
  if (limits.fastest < HUGE_VAL) {
    const auto good = good_grid_cells(workload, costs, limits);
    if (!good) return std::nullopt;
    if (good->time > good_grid_excess * limits.fastest) return not_tuned(GridParameters{good->cells});
  }
  const auto cells = best_grid_cells(workload, costs, limits);
  return cells ? std::optional(FoundParameters{GridParameters{*cells}}) : std::nullopt;
}

const std::array<TechniqueModel, all_techniques.size()> registry{{
    {Technique::brute_force, in_blocks<BruteForceParameters, brute_force>},
    {Technique::sphere_cache, in_blocks<SphereCacheParameters, corrected_cache>, best_cache, uncounted_cache},
    {Technique::sphere_cache_published, predicted<SphereCacheParameters, published_cache>, best_cache, uncounted_cache},
    {Technique::cell_spheres, in_blocks<CellSpheresParameters, cell_sphere_counts>, best_cells, uncounted_cells},
    {Technique::sphere_tree, predicted<SphereTreeParameters, sphere_tree_counts>, best_sphere_tree,
     uncounted_sphere_tree},
    {Technique::box_tree, counts_of_box_tree, best_box_tree, uncounted_box_tree},
    {Technique::octree, predicted<OctreeParameters, octree>, best_octree, uncounted_octree},
    {Technique::grid, predicted<GridParameters, grid>, best_grid, uncounted_grid},
    {Technique::bsp},
    {Technique::bvh},
    {Technique::ray_map},
    {Technique::photon_map},
}};

}  // namespace

const TechniqueModel& model_of(Technique technique) { return registry[static_cast<std::size_t>(technique)]; }

}  // namespace detp::model
