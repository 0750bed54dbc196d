#pragma once

#include <string>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::model {

/// Expected counts of a candidate on a workload, by the corrected formulas. The paper's formulas predict
/// sphere-cache-published, which walks as the paper says. `price` converts the counts to time.
///
/// The plain engine searches all rays at once. The simd engine makes lists and visits discs again for each block of
/// rays_in_block rays. Its lists for boxes also hold some rays that miss the box, so a box tree makes more tests. All
/// other counts are the same.
///
/// Throws std::invalid_argument for a workload or parameters out of range, and for candidates without a closed form:
/// bsp, bvh, ray-map and photon-map, octrees with neighbour links, sphere caches along the Hilbert curve.
[[nodiscard]] Counts<double> predict(const Valid<Workload>& workload, const Valid<Candidate>& candidate,
                                     Engine engine = Engine::simd);

/// The reasons why the counts that `predict` returns for the candidate are extrapolated: a short text for each input
/// outside the range that was compared with counts (detp/model/closed_form/reasons.hpp), such as "d over r0 1e-05 below 0.0001". Empty if the
/// counts are not extrapolated.
///
/// Throws std::invalid_argument for an invalid workload or invalid parameters.
[[nodiscard]] std::vector<std::string> extrapolations(const Valid<Workload>& workload,
                                                      const Valid<Candidate>& candidate);

}  // namespace detp::model
