#pragma once

#include <optional>
#include <string>
#include <vector>

#include "registry.hpp"

/// Chooses a technique and its parameters from the numbers of a workload alone.
namespace detp::model {

/// A technique with its best parameters for a workload.
struct Ranked {
  Candidate candidate;
  Counts<double> counts;                  ///< expected
  CostBreakdown time;                     ///< expected, in the unit of the costs
  std::vector<std::string> extrapolated;  ///< reasons why the counts are extrapolations; empty if they are not
};

/// All exact techniques with a closed form, each with its best parameters, fastest first. After a stop request those
/// tried by then, at least one.
///
/// The sphere caches by best_ratio_and_stop; cell spheres and the octree over their depths; the sphere tree over
/// fan-outs from 2 to 16 and leaves from 1 to 1024; the box tree by box_tree_rule; the grid by best_grid_cells.
/// Throws std::invalid_argument for a workload out of range.
[[nodiscard]] std::vector<Ranked> rank(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                       const SearchLimits& limits = {});

/// One technique with its best parameters; nothing where it has none within the limits (spheres as large as S₀, more
/// references than allowed) or no closed form.
[[nodiscard]] std::optional<Ranked> best_of(Technique technique, const Valid<Workload>& workload,
                                            const Valid<UnitCosts>& costs, const SearchLimits& limits = {});

/// One technique with the parameters that are given; the others are the best, as far as a closed form knows them, or
/// else the defaults. Nothing where there are none within the limits. Throws std::invalid_argument for a workload or
/// parameter out of range, and for parameters of another technique.
[[nodiscard]] std::optional<Candidate> complete(Technique technique, const Wish& wish, const Valid<Workload>& workload,
                                                const Valid<UnitCosts>& costs, const SearchLimits& limits = {});

/// One candidate as `rank` would show it.
[[nodiscard]] Ranked assess(const Valid<Workload>& workload, const Valid<Candidate>& candidate,
                            const Valid<UnitCosts>& costs);

}  // namespace detp::model
