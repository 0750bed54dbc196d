#pragma once

#include <optional>
#include <vector>

#include "detp/model/techniques/registry.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::model {

/// All exact techniques with a closed form, each with good parameters, fastest first. The time of the first is at most
/// 1 % longer than the shortest that an exhaustive search finds (400 random workloads and unit costs,
/// tests/model/rank/choose.test.cpp). After a stop request, the ranking has only the techniques tried before the request,
/// but at least one.
///
/// Brute force comes first, then the box tree: leaves from 4 to 256, doubled and halved from 32 as long as that pays; fan-outs
/// of 4, 8 and 16 over the binary tree of each leaf. Of the others only those are tuned that may still win:
///
///     sphere cache     1 to 8 ratios with their best k (good_ratio_below); tuned (best_ratio_and_stop) if that takes
///                      less than 1.5 times as long as the fastest so far, without the costs that Q and k do not change
///     cell spheres     all depths, until the spheres alone take longer than the best depth
///     octree           all depths, until nodes and insertions alone take longer than the best depth
///     sphere tree      one or two shapes; all those of best_of if that takes less than 3 times as long
///     grid             1, 2, 4 … cells; best_grid_cells if that takes less than 1.5 times as long
///
/// Parameters are those for one thread; then the number of threads is chosen, at most limits.threads (fastest_price). The
/// counts are those of the costs' engine.
///
/// Cost       4.0 million instructions for D = 2, 2.0 for D = 3, 5.7 for D = 2.4, most of them for the binary trees of box
///            trees and for the ratio of the sphere cache (means over 40 random workloads at the built-in unit costs,
///            valgrind --tool=callgrind).
///            The first call of a program also makes a table of box_tree_boxes.cpp.
/// Throws     std::invalid_argument for a workload or a number of threads out of range.
[[nodiscard]] std::vector<Prediction> rank(const Valid<Workload>& workload, const Valid<CostTable>& costs,
                                           const SearchLimits& limits = {});

/// One technique with its best parameters: the sphere cache by best_ratio_and_stop; cell spheres and the octree by trying
/// their depths; the sphere tree by trying fan-outs from 2 to 16 and leaves from 1 to 1024; the box tree by trying fan-outs
/// of 4, 8 and 16 with leaves of 4, 8 … 256; the grid by best_grid_cells. nullopt if the technique has no closed form, if
/// no parameters are within the limits, or if the best sphere cache has no spheres, which is brute force.
[[nodiscard]] std::optional<Prediction> best_of(Technique technique, const Valid<Workload>& workload,
                                                const Valid<CostTable>& costs, const SearchLimits& limits = {});

/// One technique with the parameters in `fixed`. The others are the best ones if a closed form gives them, else the
/// defaults. nullopt if no parameters are within the limits. Throws std::invalid_argument for a workload or parameter
/// out of range, and for parameters of another technique.
[[nodiscard]] std::optional<Candidate> complete(Technique technique, const FixedParameters& fixed,
                                                const Valid<Workload>& workload, const Valid<CostTable>& costs,
                                                const SearchLimits& limits = {});

/// Whether `complete` chooses a parameter by the workload.
[[nodiscard]] bool is_open(Technique technique, const FixedParameters& fixed);

/// The technique with the parameters in `fixed`, the others by default. Throws as `complete`.
[[nodiscard]] Candidate candidate_with(Technique technique, const FixedParameters& fixed);

/// One candidate as `rank` would return it, on the number of threads, at most `most_threads`, that is fastest.
[[nodiscard]] Prediction assess(const Valid<Workload>& workload, const Valid<Candidate>& candidate,
                                const Valid<CostTable>& costs, int most_threads = 1);

/// The processor's cache, which should hold the rays of the innermost sphere, and the memory of a ray.
struct ProcessorCache {
  double bytes = 1 << 20;     ///< size of the cache, bytes > 0; the default is a common L2
  double bytes_per_ray = 64;  ///< origin, direction, length and power in double precision
};

/// The paper's rule for choosing a technique.
///
///     X = mean distance between samples / d
///     X <= 2       index of discs, cells as wide as a disc (eq 21)
///     X >= 6       sphere cache, Q = 0.65
///     between      sphere cache if the rays of S_k fit the processor's cache, else index of discs
///
/// Source     sections 5 and 3; the paper took the limits of X from measurements of one scene in 2006.
/// Accuracy   refuted on 117 workloads on a machine of today (notebooks-data/zones.csv): with X <= 2 the sphere cache is as fast or
///            faster, with X >= 6 the index; the number of rays decides more than X. The rule takes 2.1 to 3.2 times as long as
///            the faster of both.
/// Throws     std::invalid_argument for a workload or cache out of range.
[[nodiscard]] Candidate paper_rule(const Valid<Workload>& workload, const ProcessorCache& cache = {});

}  // namespace detp::model
