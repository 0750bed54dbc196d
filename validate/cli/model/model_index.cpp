#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/model/disc_index/disc_index.hpp"
#include "detp/model/disc_index/disc_index_published.hpp"
#include "detp/model/disc_index/index_memory.hpp"
#include "detp/validate/cli/report/columns.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "model_answer.hpp"

namespace detp::cli {
namespace {

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

void refuse_published(const ModelQuestion& question) {
  if (question.form == Form::published)
    throw std::invalid_argument(
        fmt::format("the paper has no formula for {}; use --form corrected", detp::name(question.technique)));
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
