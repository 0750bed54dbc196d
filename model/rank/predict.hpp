#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::model {

/// Expected counts of a candidate on a workload, corrected formulas (for sphere-cache-published, which walks as the
/// paper says, the paper's). Times the unit costs (`price`) they are its time.
///
/// The plain engine makes one list of all rays; the simd engine makes lists, and visits discs, for each block of
/// rays_in_block again. Its cull of a box lists some rays that miss the box. All other counts are the same.
///
/// Throws std::invalid_argument for a workload or parameters out of range, and for candidates without a closed form:
/// bsp, bvh and photon-map, octrees with neighbour links, sphere caches along the Hilbert curve.
[[nodiscard]] Counts<double> predict(const Valid<Workload>& workload, const Valid<Candidate>& candidate,
                                     Engine engine = Engine::simd);

}  // namespace detp::model
