#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "vocabulary.hpp"

/// Which technique, with which parameters: from numbers alone.
namespace detp::model {

/// A technique with its best parameters for a workload.
struct Ranked {
  Candidate candidate;
  Counts<double> counts;                  ///< expected
  CostBreakdown time;                     ///< expected, in the unit of the costs
  std::vector<std::string> extrapolated;  ///< why the counts are (extrapolations); empty: they are not
};

/// Limits of the parameters searched.
struct SearchLimits {
  int most_depth = 14;           ///< of an octree, and of cells with spheres
  double most_cells = 1 << 26;   ///< of a grid, all together: 8 bytes each
  double most_references = 1e9;  ///< to discs in an index: 4 bytes each
  std::stop_token stop = {};     ///< ends the search: what it has found by then is given
};

/// All exact techniques with a closed form, each with its best parameters, fastest first. After a stop request those
/// tried by then, one at least.
///
/// The sphere caches by best_ratio_and_stop; cell spheres and the octree over their depths; the sphere tree by
/// best_tree; the grid over cell counts in steps of 10 %. Throws std::invalid_argument for a workload out of range.
[[nodiscard]] std::vector<Ranked> rank(const Workload& workload, const UnitCosts& costs,
                                       const SearchLimits& limits = {});

/// One technique with its best parameters; nothing where it has none within the limits (spheres as large as S₀, more
/// references than allowed, no closed form).
[[nodiscard]] std::optional<Ranked> best_of(Technique technique, const Workload& workload, const UnitCosts& costs,
                                            const SearchLimits& limits = {});

/// What is given of a sphere tree; the rest is chosen.
struct TreeWish {
  std::optional<Bounds> bounds;
  std::optional<int> fan_out;
  std::optional<int> leaf;
};

/// The sphere tree for a workload, with what is given of it. Of boxes, which are by far the faster, unless spheres are
/// asked for: then by box_tree_rule. Of spheres by best_sphere_tree. The one rule of all commands.
[[nodiscard]] SphereTreeParameters best_tree(const Workload& workload, const UnitCosts& costs,
                                             const TreeWish& wish = {});

/// The fastest sphere tree with spheres and with that fan-out and that leaf; those not given are searched for, fan-outs
/// from 2 to 16 and leaves from 1 to 1024.
[[nodiscard]] SphereTreeParameters best_sphere_tree(const Workload& workload, const UnitCosts& costs,
                                                    std::optional<int> fan_out = {}, std::optional<int> leaf = {});

/// One candidate as `rank` would show it.
[[nodiscard]] Ranked assess(const Workload& workload, const Candidate& candidate, const UnitCosts& costs);

}  // namespace detp::model
