#include "registry.hpp"

#include <algorithm>
#include <array>
#include <limits>
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
  return box_tree_counts(workload, checked_parameters<BoxTreeParameters>(candidate), engine);
}

/// Plain density estimation on the tangent plane: each disc against each ray.
Counts<double> brute_force(const Valid<Workload>& workload, const BruteForceParameters&) {
  return {.visits = workload.samples, .disc_tests = workload.rays * workload.samples, .hits = expected_hits(workload)};
}

Counts<double> published_cache(const Valid<Workload>& workload, const SphereCacheParameters& parameters) {
  require_rebuild_law(parameters.order);
  return published::counts(workload, {parameters.ratio}, parameters.spheres);
}

Counts<double> octree(const Valid<Workload>& workload, const OctreeParameters& parameters) {
  return octree_counts(workload, parameters);
}

Counts<double> grid(const Valid<Workload>& workload, const GridParameters& parameters) {
  return grid_counts(workload, parameters);
}

std::optional<Parameters> best_cache(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                     const FixedParameters& fixed, const SearchLimits&) {
  const auto ratio = fixed.value<double>("ratio");
  const auto spheres = fixed.value<std::int64_t>("spheres");
  if (workload.disc_radius >= workload.sphere_radius)
    return SphereCacheParameters{ratio.value_or(published_ratio), spheres.value_or(0)};  // no sphere holds a disc
  const BestRatio best = ratio     ? best_stop(workload, costs, {*ratio})
                         : spheres ? best_ratio_for(workload, costs, *spheres)
                                   : best_ratio_and_stop(workload, costs);
  return SphereCacheParameters{ratio.value_or(best.ratio), spheres.value_or(best.spheres)};
}

std::optional<Parameters> best_cells(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                     const FixedParameters&, const SearchLimits& limits) {
  Fastest<CellSpheresParameters> fastest(costs, Technique::cell_spheres, limits);
  for (int depth = 0; depth <= std::min(limits.most_depth, 16) && !limits.stop.stop_requested(); ++depth)
    fastest.consider({depth}, cell_sphere_counts(workload, {depth}));
  return fastest.best();
}

std::optional<Parameters> best_sphere_tree(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                           const FixedParameters& fixed, const SearchLimits& limits) {
  constexpr std::array<std::int64_t, 7> fan_outs{2, 3, 4, 6, 8, 12, 16};
  constexpr std::array<std::int64_t, 14> leaves{1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 64, 128, 256, 1024};
  const auto only = [&](std::string_view name, std::span<const std::int64_t> all) {
    const auto value = fixed.value<std::int64_t>(name);
    return value ? std::vector<std::int64_t>{*value} : std::vector<std::int64_t>(all.begin(), all.end());
  };
  Fastest<SphereTreeParameters> fastest(costs, Technique::sphere_tree, limits);
  for (const std::int64_t fan_out : only("fan-out", fan_outs))
    for (const std::int64_t leaf : only("leaf", leaves)) {
      const SphereTreeParameters tree{static_cast<int>(fan_out), static_cast<int>(leaf)};
      fastest.consider(tree, sphere_tree_counts(workload, tree));
    }
  return fastest.best();
}

/// Tries all leaves with a fan-out of 8, and then all fan-outs with the best leaf.
std::optional<Parameters> best_box_tree(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                        const FixedParameters& fixed, const SearchLimits& limits) {
  SearchLimits any_size = limits;  // a box tree holds each disc once
  any_size.most_references = std::numeric_limits<double>::infinity();
  Fastest<BoxTreeParameters> fastest(costs, Technique::box_tree, any_size);
  const auto consider = [&](std::int64_t fan_out, std::int64_t leaf) {
    if (fastest.best() && limits.stop.stop_requested()) return;
    const BoxTreeParameters tree{static_cast<int>(fan_out), static_cast<int>(leaf)};
    fastest.consider(tree, box_tree_counts(workload, tree, limits.engine));
  };
  const auto fixed_fan_out = fixed.value<std::int64_t>("fan-out");
  const auto fixed_leaf = fixed.value<std::int64_t>("leaf");
  if (fixed_leaf) consider(fixed_fan_out.value_or(8), *fixed_leaf);
  if (!fixed_leaf)
    for (const std::int64_t leaf : {4, 8, 16, 32, 64, 128, 256}) consider(fixed_fan_out.value_or(8), leaf);
  if (!fixed_fan_out)
    for (const std::int64_t fan_out : {4, 16}) consider(fan_out, fastest.best()->leaf);
  return fastest.best();
}

/// The best depth for top-down traversal, whatever the traversal is.
std::optional<Parameters> best_octree(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                      const FixedParameters&, const SearchLimits& limits) {
  const auto depth = best_octree_depth(workload, costs, limits);
  return depth ? std::optional<Parameters>(OctreeParameters{*depth}) : std::nullopt;
}

std::optional<Parameters> best_grid(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                    const FixedParameters&, const SearchLimits& limits) {
  const auto cells = best_grid_cells(workload, costs, limits);
  return cells ? std::optional<Parameters>(GridParameters{*cells}) : std::nullopt;
}

const std::array<TechniqueModel, all_techniques.size()> registry{{
    {Technique::brute_force, in_blocks<BruteForceParameters, brute_force>},
    {Technique::sphere_cache, in_blocks<SphereCacheParameters, sphere_cache_counts>, best_cache, uncounted_cache},
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
