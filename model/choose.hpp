#pragma once

#include <optional>
#include <vector>

#include "vocabulary.hpp"

/// Which technique, with which parameters: from numbers alone.
namespace detp::model {

/// A technique with its best parameters for a workload.
struct Ranked {
  Candidate candidate;
  Counts<double> counts;  ///< expected
  CostBreakdown time;     ///< expected, in the unit of the costs
};

/// Limits of the parameters searched.
struct SearchLimits {
  int most_depth = 14;           ///< of an octree
  double most_cells = 1 << 26;   ///< of a grid, all together: 8 bytes each
  double most_references = 1e9;  ///< to discs in an index: 4 bytes each
};

/// All exact techniques, each with its best parameters, fastest first.
///
/// The sphere caches by best_ratio_and_stop; the octree over its depths; the grid over cell counts in steps of 10 %.
/// Throws std::invalid_argument for a workload out of range.
[[nodiscard]] std::vector<Ranked> rank(const Workload& workload, const UnitCosts& costs,
                                       const SearchLimits& limits = {});

/// One technique with its best parameters; nothing where it has none within the limits (spheres as large as S₀, more
/// references than allowed).
[[nodiscard]] std::optional<Ranked> best_of(Technique technique, const Workload& workload, const UnitCosts& costs,
                                            const SearchLimits& limits = {});

/// One candidate as `rank` would show it.
[[nodiscard]] Ranked assess(const Workload& workload, const Candidate& candidate, const UnitCosts& costs);

}  // namespace detp::model
