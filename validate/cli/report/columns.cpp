#include "columns.hpp"

#include <algorithm>

#include "detp/validate/choice/candidate_json.hpp"

namespace detp::cli {

const Columns& workload_columns() {
  static const Columns columns{
      "scene", "field",         "rays",       "samples",   "disc_radius",   "ray_file",        "front_facing",
      "seed",  "sphere_radius", "scene_side", "dimension", "sample_extent", "sample_distance", "path_length"};
  return columns;
}

const Columns& candidate_columns() {
  static const Columns columns = [] {
    Columns all{"technique", "parameters"};
    for (const Technique technique : all_techniques) {
      const Json parameters = to_json(default_candidate(technique));
      for (const auto& [parameter, value] : parameters.items())
        if (std::find(all.begin(), all.end(), parameter) == all.end()) all.push_back(parameter);
    }
    return all;
  }();
  return columns;
}

Columns count_columns(const std::string& prefix) {
  Columns columns;
  for_each_term(Counts<double>{},
                [&](std::string_view term, double) { columns.push_back(prefix + std::string(term)); });
  columns.push_back(prefix + "tests");
  return columns;
}

Json workload_cells(const Json& inputs) {
  Json cells;
  for (const std::string& column : workload_columns())
    if (inputs.contains(column)) cells[column] = inputs[column];
  return cells;
}

Json candidate_cells(const Candidate& candidate) {
  Json cells{{"technique", name(candidate.technique)}, {"parameters", describe(candidate)}};
  cells.update(to_json(candidate));
  return cells;
}

Json count_cells(const Json& counts) {
  Json cells = counts;
  cells["tests"] = counts["cull_tests"].get<double>() + counts["disc_tests"].get<double>();
  return cells;
}

}  // namespace detp::cli
