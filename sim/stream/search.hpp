#pragma once

#include "detp/sim/technique/technique.hpp"

/// Rays streamed, block by block, down a tree of boxes: all hits, by float kernels whose every doubtful decision is
/// made again in double.
namespace detp::sim::stream {

/// Whether floats can serve: rays start within 6·10⁸ radii of S₀. (Beyond, the slack is so large that nothing is
/// culled.)
[[nodiscard]] bool can_search(const Problem& problem);

/// What the memory of a search depends on.
struct SearchSize {
  std::size_t discs = 0;
  std::size_t rays = 0;  ///< that it is given at once
  int threads = 1;       ///< 0: all cores
  bool sums = true;  ///< powers are summed, where rays differ in power, or pairs, fronts or shared totals are wanted
  bool own_totals = true;  ///< it fills in the outcome's hits and irradiance
};

[[nodiscard]] SearchSize size_of(const Problem& problem, const RunOptions& options);

/// Predicted bytes of a search at its peak, beside rays, discs and pairs: sorted discs and their tree, lists of rays,
/// sums, outcome. The lists' part holds for rays through all of the discs; a thread checks again before its lists grow.
/// The searches throw std::length_error, naming the bytes, where it would not fit the memory. `nodes` are those of the
/// binary tree that is built first.
[[nodiscard]] double boxes_bytes(const SearchSize& size, int fan_out, double nodes);

/// The most such nodes: for so many discs, with so many a leaf.
[[nodiscard]] double most_nodes(std::size_t discs, int leaf);

/// The same of search_all.
[[nodiscard]] double all_bytes(const SearchSize& size);

/// The same of search_walk, sorting before it included, if lists inside the outermost hold `nested` times its rays.
[[nodiscard]] double walk_bytes(const SearchSize& size, double nested);

/// Tests every ray against every disc. (Of rays that pass S₀ that takes no test; they count as tested.)
void search_all(const Problem& problem, const RunOptions& options, Outcome& outcome);

/// Finds the hits of all rays. Same bytes for any number of threads.
///
/// Counts: `rebuilds` are nodes that a list was culled for, `sphere_tests` tests of a ray against a box, `copies` rays
/// listed.
void search_boxes(const Problem& problem, const SphereTreeParameters& parameters, const RunOptions& options,
                  Outcome& outcome);

}  // namespace detp::sim::stream
