#pragma once

#include "detp/sim/search/index.hpp"
#include "disc_tree.hpp"
#include "ray_list.hpp"

/// Rays streamed, block by block, down a tree of boxes: all hits, by float kernels whose every doubtful decision is
/// made again in double.
namespace detp::sim::stream {

/// Whether floats can serve: rays start within 6·10⁸ radii of S₀. (Beyond, the slack is so large that nothing is
/// culled.)
[[nodiscard]] bool can_search(const Problem& problem);

/// What the memory of a search depends on.
struct SearchSize {
  std::size_t discs = 0;
  std::size_t rays = 0;   ///< that it is given at once
  int threads = 1;        ///< 0: all cores
  bool segments = false;  ///< one of the rays ends
  bool sums = true;  ///< powers are summed, where rays differ in power, or pairs, fronts or shared totals are wanted
  bool own_totals = true;  ///< it fills in the outcome's hits and irradiance
};

[[nodiscard]] SearchSize size_of(const Problem& problem, const RunOptions& options);

/// What the memory of a tree of boxes depends on: as of DiscTree.
struct TreeSize {
  double binary_nodes = 0;
  double nodes = 0;
  ListRoom lists = {};
};

/// That expected of so many discs: leaves are half full, and their parents halve the cells that they are in. Where
/// discs crowd into a few cells there may be more nodes; make_disc_tree checks again while it writes them.
[[nodiscard]] TreeSize expected_tree(std::size_t discs, const BoxTreeParameters& parameters);

/// Predicted bytes of a search at its peak, beside rays, discs, pairs and the copy kept for a stopped run (which are
/// checked when they are taken): sorted discs and their tree, lists of rays, sums, outcome.
///
/// All of it follows from the sizes of arrays, but for the lists of rays inside the outermost: how many rays they hold
/// is random. That part is what lines need, isotropic and uniform through S₀. Others that crowd into one place need
/// more: a thread checks again before its lists grow. Pages not touched, and what the heap keeps of arrays given back,
/// are left out. The searches throw std::length_error, naming the bytes, where it would not fit the memory.
[[nodiscard]] double boxes_bytes(const SearchSize& size, int fan_out, const TreeSize& tree);

/// The same of search_all.
[[nodiscard]] double all_bytes(const SearchSize& size);

/// The same of search_walk, sorting before it included.
[[nodiscard]] double walk_bytes(const SearchSize& size, const ListRoom& lists);

/// Floats of one thread's lists inside one another, touched or not.
[[nodiscard]] std::size_t list_floats(const SearchSize& size, const ListRoom& lists);

/// What is searched: the rays of a problem, by the discs in an order, or a tree of them.
struct Searched {
  const Problem& problem;
  const Frame& frame;
  const DiscTree& tree;
};

/// The index of brute force: tests every ray against every disc. (Of rays that pass S₀ that takes no test; they count
/// as tested.)
[[nodiscard]] std::unique_ptr<Index> prepare_all(const Problem& problem, const RunOptions& options);

/// Finds the hits of all rays, whose lists are culled down a tree of boxes. Same bytes for any number of threads.
void search_boxes(const Searched& searched, int fan_out, const RunOptions& options, Outcome& outcome);

}  // namespace detp::sim::stream
