#pragma once

#include "detp/validate/map/technique_map.hpp"

/// Maps for tests.
namespace detp::support {

inline validate::Analysed measured(Technique technique, double seconds, double spread) {
  return {.candidate = default_candidate(technique), .seconds = seconds, .spread = spread};
}

/// A cell where box-tree is predicted; the analysis has it first, then `other`.
inline validate::MapCell cell_of(double rays, double box_tree_seconds, const validate::Analysed& other) {
  validate::MapCell cell{.rays = rays, .paper = default_candidate(Technique::octree)};
  cell.choice.emplace();
  cell.choice->candidates.push_back({.candidate = default_candidate(Technique::box_tree), .time = {.intersect = 1e-3}});
  cell.analysis.emplace();
  cell.analysis->candidates = {measured(Technique::box_tree, box_tree_seconds, 0.1), other};
  cell.analysis->best = box_tree_seconds <= *other.seconds ? 0 : 1;
  cell.analysis->regret = box_tree_seconds / std::min(box_tree_seconds, *other.seconds) - 1;
  return cell;
}

/// Two radii and two numbers of rays. Of the cells, one agrees, one differs, one differs within noise and one was not
/// measured.
inline validate::TechniqueMap small_map() {
  validate::TechniqueMap map;
  map.name = "@small";
  map.rays = {100, 1000};
  for (const double radius : {0.01, 0.04}) {
    validate::MapRow& row = map.rows.emplace_back();
    row.given = {radius, true};
    row.workload = cube_workload(1000, 50, radius, 1);
    row.x = sample_distance(row.workload) / radius;
  }
  map.rows[0].cells = {cell_of(100, 1.0, measured(Technique::grid, 2.0, 0.1)),
                       cell_of(1000, 4.0, measured(Technique::grid, 1.0, 0.1))};
  map.rows[1].cells = {cell_of(100, 1.1, measured(Technique::grid, 1.0, 0.1)),
                       cell_of(1000, 1.0, measured(Technique::grid, 2.0, 0.1))};
  map.rows[1].cells[1].analysis.reset();
  return map;
}

}  // namespace detp::support
