#pragma once

#include "counts.hpp"
#include "engine.hpp"
#include "technique.hpp"

namespace detp {

/// Bytes of memory that a search with these counts touches for the first time, if no earlier search left it its arrays: the discs'
/// order, index and sums, blocks of rays with their lists, and the results. The rays and discs themselves are not included.
///
/// Source     sizes of the arrays of `sim`; the lists inside a block of rays have as many rays together as the block
/// Accuracy   against the page faults of 4 to 57 MB of fresh memory (tests/validate/bytes_touched.test.cpp): box trees, brute force, sphere
///            caches, cell spheres and BVHs within 25 %, others within a factor of 2
[[nodiscard]] double bytes_touched(const Counts<double>& counts, const Candidate& candidate, Engine engine);

/// The counts, predicted or counted, with that in `bytes_touched`.
template <class T>
[[nodiscard]] Counts<T> with_bytes_touched(Counts<T> counts, const Candidate& candidate, Engine engine) {
  counts.bytes_touched = static_cast<T>(bytes_touched(as_expected(counts), candidate, engine));
  return counts;
}

}  // namespace detp
