#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::model {

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
