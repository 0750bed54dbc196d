#pragma once

#include <optional>
#include <string>
#include <vector>

#include "registry.hpp"

namespace detp::model {

/// A technique with its best parameters for a workload.
struct Ranked {
  Candidate candidate;
  Counts<double> counts;                  ///< expected
  CostBreakdown time;                     ///< expected, in the unit of the costs
  std::vector<std::string> extrapolated;  ///< reasons why the counts are extrapolations; empty if they are not
  /// false: the parameters are good, but not the best, because with the best ones another technique is still faster
  bool tuned = true;
};

/// All exact techniques with a closed form, each with its best parameters, fastest first. After a stop request, the
/// ranking has only the techniques tried before the request, but at least one.
///
/// Parameters: the sphere cache by best_ratio_and_stop; cell spheres and the octree by trying their depths; the sphere
/// tree by trying fan-outs from 2 to 16 and leaves from 1 to 1024; the box tree by trying leaves from 4 to 256, and then
/// fan-outs from 4 to 16; the grid by best_grid_cells. Throws std::invalid_argument for a workload out of range.
[[nodiscard]] std::vector<Ranked> rank(const Valid<Workload>& workload, const Valid<CostTable>& costs,
                                       const SearchLimits& limits = {});

/// One technique with its best parameters. nullopt if the technique has no closed form, if no parameters are within the
/// limits, or if the best sphere cache has no spheres, which is brute force.
[[nodiscard]] std::optional<Ranked> best_of(Technique technique, const Valid<Workload>& workload,
                                            const Valid<CostTable>& costs, const SearchLimits& limits = {});

/// One technique with the parameters in `fixed`. The others are the best ones if a closed form gives them, else the
/// defaults. nullopt if no parameters are within the limits. Throws std::invalid_argument for a workload or parameter
/// out of range, and for parameters of another technique.
[[nodiscard]] std::optional<Candidate> complete(Technique technique, const FixedParameters& fixed,
                                                const Valid<Workload>& workload, const Valid<CostTable>& costs,
                                                const SearchLimits& limits = {});

/// One candidate as `rank` would return it.
[[nodiscard]] Ranked assess(const Valid<Workload>& workload, const Valid<Candidate>& candidate,
                            const Valid<CostTable>& costs);

}  // namespace detp::model
