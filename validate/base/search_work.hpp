#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

/// Predicts the units of work (sim::StopCheck) that a search reports, for a display of progress. An error of 20 % does
/// not matter.
namespace detp::validate {

/// Units of work of the tests and steps of a search with these counts. Techniques with lists of rays report 16 tests as
/// one unit if their engine is simd. All other searches report each test, step and node as one unit.
[[nodiscard]] inline double test_work(const Counts<double>& counts, Engine engine = Engine::simd) {
  const bool over_lists = counts.culls > 0 || counts.steps + counts.nodes == 0;
  if (engine == Engine::simd && over_lists) return tests(counts) / 16;
  return tests(counts) + counts.steps + counts.nodes;
}

/// Units of work that do not depend on the number of rays: sorting the discs, building the index, and one unit for each
/// list and each visit of a disc.
[[nodiscard]] inline double build_work(const Counts<double>& counts) {
  constexpr double sorting = 9;  // per disc
  constexpr double placing = 8;  // per disc and node
  return counts.culls + counts.visits + sorting * counts.sorted + counts.references + placing * counts.placements;
}

[[nodiscard]] inline double search_work(const Counts<double>& counts, Engine engine = Engine::simd) {
  return test_work(counts, engine) + build_work(counts);
}

}  // namespace detp::validate
