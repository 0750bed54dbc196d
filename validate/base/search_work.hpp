#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

/// Units of work (sim::StopCheck) that searches report, for a display of progress. An accuracy of a fifth is enough.
namespace detp::validate {

/// Units of work for the tests and steps of a search with these counts. A float engine over lists of rays reports 16
/// tests as a unit; others report each test and step.
[[nodiscard]] inline double test_work(const Counts<double>& counts, Engine engine = Engine::simd) {
  const bool over_lists = counts.culls > 0 || counts.steps + counts.nodes == 0;
  if (engine == Engine::simd && over_lists) return tests(counts) / 16;
  return tests(counts) + counts.steps + counts.nodes;
}

/// Units of work that each search does regardless of the number of rays: sorting, building, starting lists and discs.
[[nodiscard]] inline double build_work(const Counts<double>& counts) {
  constexpr double sorting = 9;  // per disc
  constexpr double placing = 8;  // per disc and node
  return counts.culls + counts.visits + sorting * counts.sorted + counts.references + placing * counts.placements;
}

[[nodiscard]] inline double search_work(const Counts<double>& counts, Engine engine = Engine::simd) {
  return test_work(counts, engine) + build_work(counts);
}

}  // namespace detp::validate
