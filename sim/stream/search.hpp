#pragma once

#include "detp/sim/technique/technique.hpp"

/// Rays streamed, block by block, down a tree of boxes: all hits, by float kernels whose every doubtful decision is
/// made again in double.
namespace detp::sim::stream {

/// Whether floats can serve: rays start within 6·10⁸ radii of S₀. (Beyond, the slack is so large that nothing is
/// culled.)
[[nodiscard]] bool can_search(const Problem& problem);

/// Bytes that a search takes at most beside its input and outcome, pairs left out: the discs in order and their tree,
/// sums, lists of rays. The searches throw std::length_error, naming them, where they would not fit the memory.
[[nodiscard]] double search_bytes(std::size_t discs, int threads);
void require_search_memory(const Problem& problem, const RunOptions& options);

/// Tests every ray against every disc. (Of rays that pass S₀ that takes no test; they count as tested.)
void search_all(const Problem& problem, const RunOptions& options, Outcome& outcome);

/// Finds the hits of all rays. Same bytes for any number of threads.
///
/// Counts: `rebuilds` are nodes that a list was culled for, `sphere_tests` tests of a ray against a box, `copies` rays
/// listed.
void search_boxes(const Problem& problem, const SphereTreeParameters& parameters, const RunOptions& options,
                  Outcome& outcome);

}  // namespace detp::sim::stream
