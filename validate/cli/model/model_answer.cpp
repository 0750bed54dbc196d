#include "model_answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/model/disc_index/disc_index.hpp"
#include "detp/model/disc_index/disc_index_published.hpp"
#include "detp/model/disc_index/index_memory.hpp"
#include "detp/model/hierarchy/cell_spheres.hpp"
#include "detp/model/hierarchy/sphere_tree.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/model/sphere_cache/rebuild_law.hpp"
#include "detp/model/sphere_cache/sphere_cache.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/validate/cli/report/answer_rows.hpp"
#include "detp/validate/cli/report/workload_report.hpp"

namespace detp::cli {
namespace {

/// Throws std::invalid_argument if the published form is requested but the paper has none for the technique.
void refuse_published(const ModelQuestion& question) {
  if (question.form == Form::published)
    throw std::invalid_argument(
        fmt::format("the paper has no formula for {}; use --form corrected", detp::name(question.technique)));
}

SampleOrder order_of(const ModelQuestion& question) {
  const auto given = question.options.given<std::string_view>("order");
  return given ? *choice_named<SampleOrder>(*given) : SampleOrder::lebesgue;
}

SphereCacheParameters cache_parameters(const ModelQuestion& question, double ratio, const model::SphereStops& stops) {
  const std::int64_t otherwise = question.options.stop == SphereStop::best ? stops.best : stops.max;
  return {ratio, question.options.given<std::int64_t>("spheres").value_or(otherwise), order_of(question)};
}

Json published_levels(const ModelQuestion& question, const SphereCacheParameters& parameters) {
  Json levels = Json::array();
  const bool sorted = parameters.order == SampleOrder::lebesgue;
  for (std::int64_t i = 1; i <= std::min(question.levels, parameters.spheres); ++i)
    levels.push_back(
        {{"i", i},
         {"radius", question.workload.sphere_radius * std::pow(parameters.ratio, static_cast<double>(i))},
         {"rays", model::published::rays_in_sphere(question.workload.rays, {parameters.ratio}, i)},
         {"rebuilds", sorted ? model::published::rebuilds({parameters.ratio}, i) : question.workload.samples},
         {"rebuild_cost",
          model::published::rebuild_cost(question.workload.rays, {parameters.ratio}, i, question.costs.cull_test)}});
  return levels;
}

Json published_cache(const ModelQuestion& question, const SphereCacheParameters& parameters) {
  Json json{{"spheres", published_levels(question, parameters)}};
  if (parameters.order == SampleOrder::none) {
    json["total_time"] = model::published::unsorted_time(question.workload, question.costs.disc_test);
    return json;
  }
  const double rebuild = model::published::rebuild_time(question.workload, {parameters.ratio}, parameters.spheres,
                                                        question.costs.cull_test);
  const double intersect = model::published::intersect_time(question.workload, {parameters.ratio}, parameters.spheres,
                                                            question.costs.disc_test);
  json["rebuild_time"] = rebuild;
  json["intersect_time"] = intersect;
  json["total_time"] = rebuild + intersect;
  json["rebuild_time_few_samples"] =
      model::published::rebuild_time_few_samples(question.workload, {parameters.ratio}, question.costs.cull_test);
  json["counts"] = to_json(model::published::counts(question.workload, {parameters.ratio}, parameters.spheres));
  return json;
}

Json corrected_levels(const ModelQuestion& question, const SphereCacheParameters& parameters) {
  Json levels = Json::array();
  if (parameters.spheres == 0) return levels;
  for (const model::SphereLevel& level : model::sphere_levels(question.workload, parameters, question.levels))
    levels.push_back({{"i", level.i},
                      {"radius", level.radius},
                      {"rays", level.rays},
                      {"listed", level.listed},
                      {"rebuilds", level.rebuilds},
                      {"rebuild_cost", question.costs.cull_test * level.tests}});
  return levels;
}

Json corrected_cache(const ModelQuestion& question, const SphereCacheParameters& parameters) {
  const Candidate candidate = parameters.spheres == 0 ? Candidate{Technique::brute_force, BruteForceParameters{}}
                                                      : Candidate{Technique::sphere_cache, parameters};
  const Counts<double> counts = model::predict(question.workload, candidate, question.options.engine);
  const CostBreakdown time = price(counts, question.costs);
  return {{"spheres", corrected_levels(question, parameters)},
          {"rebuild_time", time.rebuild},
          {"intersect_time", time.intersect},
          {"copy_time", time.copy},
          {"order_time", time.order},
          {"total_time", time.total()},
          {"counts", to_json(counts)}};
}

ModelAnswer with_spheres(const ModelQuestion& question, const Parameters& parameters, Json levels) {
  const Candidate candidate{question.technique, parameters};
  const Counts<double> counts = model::predict(question.workload, candidate, question.options.engine);
  const CostBreakdown time = price(counts, question.costs, question.technique);
  return {parameters,
          {{"parameters", to_json(candidate)},
           {"form", name(question.form)},
           {"spheres", std::move(levels)},
           {"rebuild_time", time.rebuild},
           {"intersect_time", time.intersect},
           {"copy_time", time.copy},
           {"order_time", time.order},
           {"build_time", time.build},
           {"traverse_time", time.traverse},
           {"total_time", time.total()},
           {"counts", to_json(counts)}}};
}

Json published_octree(const ModelQuestion& question, int depth) {
  const Workload& w = question.workload;
  return {{"depth", depth},
          {"cells_per_line", model::published::cells_per_line(depth)},
          {"discs_per_cell", model::published::discs_per_cell(w.samples, depth)},
          {"tests_per_line", model::published::tests_per_line(w.samples, depth)},
          {"total_time", model::published::octree_time(w, depth, question.costs.index_test)},
          {"balanced_time", model::published::balanced_octree_time(w, depth, question.costs.index_test)}};
}

/// The index's results by the corrected form. "per line" means per line that hits the index's box.
Json corrected_index(const ModelQuestion& question, double parts, const Counts<double>& counts, double bytes) {
  const model::Cells cells = model::index_cells(question.workload, parts);
  const double references = question.workload.samples * cells.overlapped;
  double area = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) area += 2 * cells.along[axis] * cells.along[(axis + 1) % 3];
  const double share = 6 / area;  // P(cell)/P(box): areas in units of a cell's face
  const CostBreakdown time = price(counts, question.costs, question.technique);
  return {{"cells_per_line", cells.count() * share},
          {"discs_per_cell", references / cells.count()},
          {"tests_per_line", references * share},
          {"cells_per_disc", cells.overlapped},
          {"index_bytes", bytes},
          {"build_time", time.build},
          {"traverse_time", time.traverse},
          {"intersect_time", time.intersect},
          {"total_time", time.total()},
          {"counts", to_json(counts)}};
}

}  // namespace

ModelAnswer sphere_cache_answer(const ModelQuestion& question) {
  model::require_rebuild_law(order_of(question));
  const double ratio = question.options.given<double>("ratio").value_or(model::published_ratio);
  const model::SphereStops stops = model::sphere_stops(question.workload, question.costs, question.form, {ratio});
  const SphereCacheParameters parameters = cache_parameters(question, ratio, stops);
  Json json{{"parameters", to_json(Candidate{question.technique, parameters})},
            {"form", name(question.form)},
            {"k", parameters.spheres},
            {"k_max", stops.max},
            {"k_best", stops.best},
            {"k_published", model::own_spheres(question.workload, Form::published, {ratio})},
            {"k_corrected", model::own_spheres(question.workload, Form::corrected, {ratio})}};
  json.update(question.form == Form::published ? published_cache(question, parameters)
                                               : corrected_cache(question, parameters));
  return {parameters, std::move(json)};
}

ModelAnswer technique_answer(const ModelQuestion& question) {
  refuse_published(question);
  const auto candidate = model::complete(question.technique, question.options.fixed_parameters(question.technique),
                                         question.workload, question.costs);
  if (!candidate)
    throw std::length_error(fmt::format("{} would not fit in memory on this workload", name(question.technique)));
  return with_spheres(question, candidate->parameters, Json::array());
}

ModelAnswer cell_spheres_answer(const ModelQuestion& question) {
  ModelAnswer answer = technique_answer(question);
  const int depth = std::get<CellSpheresParameters>(answer.parameters).depth;
  const Workload& w = question.workload;
  double around = w.rays;
  for (int i = 1; i <= std::min<std::int64_t>(question.levels, depth); ++i) {
    const double rays = model::rays_in_cell_sphere(w, i);
    answer.json["spheres"].push_back({{"i", i},
                                      {"radius", model::cell_sphere_radius(w, i)},
                                      {"rays", rays},
                                      {"rebuilds", model::occupied_cell_spheres(w, i)},
                                      {"rebuild_cost", question.costs.cull_test * around}});
    around = rays;
  }
  return answer;
}

ModelAnswer sphere_tree_answer(const ModelQuestion& question) {
  ModelAnswer answer = technique_answer(question);
  Json& levels = answer.json["spheres"];
  double around = question.workload.rays;
  for (const model::TreeLevel& level :
       model::sphere_tree_levels(question.workload, std::get<SphereTreeParameters>(answer.parameters))) {
    if (static_cast<std::int64_t>(levels.size()) == question.levels) break;
    levels.push_back({{"i", levels.size()},
                      {"radius", level.rms_radius},
                      {"rays", level.rays},
                      {"rebuilds", level.nodes},
                      {"rebuild_cost", question.costs.cull_test * around},
                      {"samples", level.samples}});
    around = level.rays;
  }
  return answer;
}

ModelAnswer octree_answer(const ModelQuestion& question) {
  Candidate candidate{Technique::octree, OctreeParameters{model::published::octree_depth(
                                             {question.workload.disc_radius}, scene_side(question.workload))}};
  for (const auto& [name, value] : question.options.fixed_parameters(Technique::octree).values)
    set_parameter(candidate, name, value);
  const auto parameters = std::get<OctreeParameters>(candidate.parameters);
  const int depth = parameters.depth;
  const Counts<double> counts = model::octree_counts(question.workload, parameters);
  Json json{{"parameters", to_json(candidate)}, {"form", name(question.form)}, {"depth", depth}};
  json.update(question.form == Form::published ? published_octree(question, depth)
                                               : corrected_index(question, std::ldexp(1.0, depth), counts,
                                                                 model::octree_bytes(question.workload, parameters)));
  return {parameters, std::move(json)};
}

ModelAnswer grid_answer(const ModelQuestion& question) {
  refuse_published(question);
  const int depth = model::published::octree_depth({question.workload.disc_radius}, scene_side(question.workload));
  const auto cells = question.options.given<std::int64_t>("cells").value_or(1 << std::min(depth, 20));
  Candidate candidate{Technique::grid, GridParameters{}};
  set_parameter(candidate, "cells", cells);
  const auto parameters = std::get<GridParameters>(candidate.parameters);
  const Counts<double> counts = model::grid_counts(question.workload, parameters);
  Json json{{"parameters", to_json(candidate)}, {"form", name(question.form)}};
  json.update(corrected_index(question, parameters.cells, counts, model::grid_bytes(question.workload, parameters)));
  return {parameters, std::move(json)};
}

}  // namespace detp::cli
