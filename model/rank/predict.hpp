#pragma once

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

}  // namespace detp::model
