#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::validate {

/// Units of work (sim::StopCheck) that a search with these counts reports: for a display of progress, which needs no
/// better than a tenth.
///
/// A float engine over lists of rays reports 16 tests as a unit, and each list and disc that it begins; everything else
/// reports each test and step.
[[nodiscard]] inline double search_work(const Counts<double>& counts, Engine engine = Engine::simd) {
  const bool over_lists = counts.culls > 0 || counts.steps + counts.nodes == 0;
  const double build = counts.sorted + counts.references + counts.placements;
  if (engine == Engine::simd && over_lists) return tests(counts) / 16 + counts.culls + counts.visits + build;
  return tests(counts) + counts.culls + counts.visits + counts.steps + counts.nodes + build;
}

}  // namespace detp::validate
