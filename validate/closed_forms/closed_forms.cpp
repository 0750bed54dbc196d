#include "closed_forms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/model/disc_index/disc_index.hpp"
#include "detp/model/disc_index/disc_index_published.hpp"
#include "detp/model/hierarchy/cell_spheres.hpp"
#include "detp/model/hierarchy/sphere_tree.hpp"
#include "detp/model/optimum/best_published_ratio.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/model/sphere_cache/rebuild_law.hpp"
#include "detp/model/sphere_cache/sphere_cache.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"

namespace detp::validate {
namespace {

/// Throws std::invalid_argument if the published form is asked for.
void refuse_published(const ModelRequest& request) {
  if (request.form == Form::published)
    throw std::invalid_argument(
        fmt::format("the paper has no formula for {}; use --form corrected", name(request.technique)));
}

void published_cache(const ModelRequest& request, const SphereCacheParameters& cache, ModelAnswer& answer) {
  namespace published = model::published;
  const Workload& w = request.workload;
  const RadiusRatio ratio{cache.ratio};
  const bool sorted = cache.order == SampleOrder::lebesgue;
  for (std::int64_t i = 1; i <= std::min(request.levels, cache.spheres); ++i)
    answer.spheres->push_back({.i = i,
                               .radius = w.sphere_radius * std::pow(cache.ratio, static_cast<double>(i)),
                               .rays = published::rays_in_sphere(w.rays, ratio, i),
                               .rebuilds = sorted ? published::rebuilds(ratio, i) : w.samples,
                               .rebuild_cost = published::rebuild_cost(w.rays, ratio, i, request.costs.cull_test)});
  if (cache.order == SampleOrder::none) {
    answer.times.total = published::unsorted_time(w, request.costs.disc_test);
    return;
  }
  const double rebuild = published::rebuild_time(w, ratio, cache.spheres, request.costs.cull_test);
  const double intersect = published::intersect_time(w, ratio, cache.spheres, request.costs.disc_test);
  answer.times = {.rebuild = rebuild,
                  .intersect = intersect,
                  .total = rebuild + intersect,
                  .rebuild_few_samples = published::rebuild_time_few_samples(w, ratio, request.costs.cull_test)};
  answer.counts = published::counts(w, ratio, cache.spheres);
}

void corrected_cache(const ModelRequest& request, const SphereCacheParameters& cache, ModelAnswer& answer) {
  if (cache.spheres > 0)
    for (const model::SphereLevel& level : model::sphere_levels(request.workload, cache, request.levels))
      answer.spheres->push_back({.i = level.i,
                                 .radius = level.radius,
                                 .rays = level.rays,
                                 .listed = level.listed,
                                 .rebuilds = level.rebuilds,
                                 .rebuild_cost = request.costs.cull_test * level.tests});
  const Candidate candidate = cache.spheres == 0 ? Candidate{Technique::brute_force, BruteForceParameters{}}
                                                 : Candidate{Technique::sphere_cache, cache};
  answer.counts = model::predict(request.workload, candidate, request.engine);
  const CostBreakdown time = price(*answer.counts, request.costs);
  answer.times = {.rebuild = time.rebuild,
                  .intersect = time.intersect,
                  .copy = time.copy,
                  .order = time.order,
                  .total = time.total()};
}

ModelAnswer cache_answer(const ModelRequest& request) {
  for (const auto& [parameter, value] : request.parameters.values)
    if (find_parameter(request.technique, parameter) == nullptr)
      throw std::invalid_argument(fmt::format("{} is no parameter of {}", parameter, name(request.technique)));
  const auto order = request.parameters.value<std::string_view>("order");
  SphereCacheParameters cache{.order = order ? choice_named<SampleOrder>(*order).value() : SampleOrder::lebesgue};
  model::require_rebuild_law(cache.order);
  cache.ratio = request.parameters.value<double>("ratio").value_or(model::published_ratio);
  const RadiusRatio ratio{cache.ratio};
  const model::SphereStops stops = model::sphere_stops(request.workload, request.costs, request.form, ratio);
  const std::int64_t otherwise = request.fastest_stop ? stops.best : stops.max;
  cache.spheres = request.parameters.value<std::int64_t>("spheres").value_or(otherwise);
  ModelAnswer answer{.candidate = {request.technique, cache}, .form = request.form};
  answer.stops = {cache.spheres, stops.max, stops.best, model::own_spheres(request.workload, Form::published, ratio),
                  model::own_spheres(request.workload, Form::corrected, ratio)};
  answer.spheres.emplace();
  (request.form == Form::published ? published_cache : corrected_cache)(request, cache, answer);
  return answer;
}

/// Of a hierarchy, the spheres of each level.
std::vector<ModelLevel> levels_of(const ModelRequest& request, const Parameters& parameters) {
  const Workload& w = request.workload;
  std::vector<ModelLevel> levels;
  double around = w.rays;
  const auto add = [&](ModelLevel level) {
    level.rebuild_cost = request.costs.cull_test * around;
    around = level.rays;
    levels.push_back(level);
  };
  if (const auto* cells = std::get_if<CellSpheresParameters>(&parameters)) {
    for (int i = 1; i <= std::min<std::int64_t>(request.levels, cells->depth); ++i)
      add({.i = i,
           .radius = model::cell_sphere_radius(w, i),
           .rays = model::rays_in_cell_sphere(w, i),
           .rebuilds = model::occupied_cell_spheres(w, i)});
  } else if (const auto* tree = std::get_if<SphereTreeParameters>(&parameters)) {
    for (const model::TreeLevel& level : model::sphere_tree_levels(w, *tree)) {
      const auto i = static_cast<std::int64_t>(levels.size());
      if (i == request.levels) break;
      add({.i = i, .radius = level.rms_radius, .rays = level.rays, .rebuilds = level.nodes, .samples = level.samples});
    }
  }
  return levels;
}

ModelAnswer hierarchy_answer(const ModelRequest& request) {
  refuse_published(request);
  const auto candidate = model::complete(request.technique, request.parameters, request.workload, request.costs);
  if (!candidate)
    throw std::length_error(fmt::format("{} would not fit in memory on this workload", name(request.technique)));
  ModelAnswer answer{.candidate = *candidate, .form = request.form};
  answer.spheres = levels_of(request, candidate->parameters);
  answer.counts = model::predict(request.workload, *candidate, request.engine);
  const CostBreakdown time = price(*answer.counts, request.costs, request.technique);
  answer.times = {.rebuild = time.rebuild,
                  .intersect = time.intersect,
                  .copy = time.copy,
                  .order = time.order,
                  .build = time.build,
                  .traverse = time.traverse,
                  .total = time.total()};
  return answer;
}

void published_octree(const ModelRequest& request, int depth, ModelAnswer& answer) {
  namespace published = model::published;
  const Workload& w = request.workload;
  answer.index = {.depth = depth,
                  .cells_per_line = published::cells_per_line(depth),
                  .discs_per_cell = published::discs_per_cell(w.samples, depth),
                  .tests_per_line = published::tests_per_line(w.samples, depth)};
  answer.times.total = published::octree_time(w, depth, request.costs.index_test);
  answer.times.balanced = published::balanced_octree_time(w, depth, request.costs.index_test);
}

/// By the corrected form. `parts`: cells along the longest side.
void corrected_index(const ModelRequest& request, double parts, double bytes, ModelAnswer& answer) {
  const model::Cells cells = model::index_cells(request.workload, parts);
  const double references = request.workload.samples * cells.overlapped;
  double area = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) area += 2 * cells.along[axis] * cells.along[(axis + 1) % 3];
  const double share = 6 / area;  // P(cell)/P(box): areas in units of a cell's face
  answer.index = {.cells_per_line = cells.count() * share,
                  .discs_per_cell = references / cells.count(),
                  .tests_per_line = references * share,
                  .cells_per_disc = cells.overlapped,
                  .bytes = bytes};
  const CostBreakdown time = price(*answer.counts, request.costs, request.technique);
  answer.times = {.intersect = time.intersect, .build = time.build, .traverse = time.traverse, .total = time.total()};
}

/// The paper's depth for the workload's discs.
int octree_depth(const Workload& workload) {
  return model::published::octree_depth({workload.disc_radius}, scene_side(workload));
}

ModelAnswer octree_answer(const ModelRequest& request) {
  ModelAnswer answer{.candidate = {Technique::octree, OctreeParameters{octree_depth(request.workload)}},
                     .form = request.form};
  for (const auto& [name, value] : request.parameters.values) set_parameter(answer.candidate, name, value);
  const auto octree = std::get<OctreeParameters>(answer.candidate.parameters);
  if (request.form == Form::published) {
    published_octree(request, octree.depth, answer);
    return answer;
  }
  answer.counts = model::octree_counts(request.workload, octree);
  corrected_index(request, std::ldexp(1.0, octree.depth), model::octree_bytes(request.workload, octree), answer);
  answer.index->depth = octree.depth;
  return answer;
}

ModelAnswer grid_answer(const ModelRequest& request) {
  refuse_published(request);
  ModelAnswer answer{.candidate = {Technique::grid, GridParameters{}}, .form = request.form};
  set_parameter(answer.candidate, "cells", std::int64_t{1} << std::min(octree_depth(request.workload), 20));
  for (const auto& [name, value] : request.parameters.values) set_parameter(answer.candidate, name, value);
  const auto grid = std::get<GridParameters>(answer.candidate.parameters);
  answer.counts = model::grid_counts(request.workload, grid);
  corrected_index(request, grid.cells, model::grid_bytes(request.workload, grid), answer);
  return answer;
}

ModelAnswer technique_answer(const ModelRequest& request) {
  using enum Technique;
  if (!model::has_closed_form(request.technique))
    throw std::invalid_argument(fmt::format("there is no closed form of {}; try: detp run --technique {}",
                                            name(request.technique), name(request.technique)));
  if (request.technique == sphere_cache || request.technique == sphere_cache_published) return cache_answer(request);
  if (request.technique == octree) return octree_answer(request);
  return request.technique == grid ? grid_answer(request) : hierarchy_answer(request);
}

}  // namespace

ModelAnswer answer(const ModelRequest& request) {
  ModelAnswer answer = technique_answer(request);
  answer.outlook = outlook(request, answer.candidate.parameters);
  answer.extrapolated_because = model::extrapolations(request.workload, answer.candidate);
  if (!std::isfinite(answer.times.total))
    throw std::invalid_argument("with these unit costs the time exceeds 1.8e308; give smaller costs");
  return answer;
}

ModelComparison compare(const ModelRequest& request, const ModelAnswer& answer) {
  ModelComparison found;
  ModelRequest other = request;
  other.form = request.form == Form::published ? Form::corrected : Form::published;
  if (answer.stops) {
    if (answer.stops->most == 0) return found;
    model::BestRatio best;
    if (request.form == Form::published) {
      const auto published = model::published::best_ratio(request.workload, request.costs);
      best = {published.ratio, published.spheres, published.time};
    } else {
      best = model::best_ratio_and_stop(request.workload, request.costs);
      best.time += model::time_at_any_ratio(request.workload, request.costs);
    }
    found.best = best.spheres == 0
                     ? Candidate{Technique::brute_force, BruteForceParameters{}}
                     : Candidate{Technique::sphere_cache, SphereCacheParameters{best.ratio, best.spheres}};
    found.best_time = best.time;
    found.other_form = cache_answer(other);
    return found;
  }
  if (request.technique == Technique::octree) found.other_form = octree_answer(other);
  if (request.form == Form::published) return found;
  found.best = model::complete(request.technique, {}, request.workload, request.costs);
  if (!found.best) return found;
  const auto counts = model::predict(request.workload, *found.best, request.engine);
  found.best_time = price(counts, request.costs, request.technique).total();
  return found;
}

}  // namespace detp::validate
