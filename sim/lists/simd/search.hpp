#pragma once

#include "detp/sim/lists/list_walk.hpp"
#include "detp/sim/search/index.hpp"
#include "disc_tree.hpp"
#include "ray_list.hpp"

/// Streams rays, block by block, down a tree of boxes. Finds all hits with float kernels; every uncertain decision is
/// repeated in double.
namespace detp::sim::stream {

/// Whether floats are precise enough: the slack must be at most 0.01 in the frame's units. So rays must start within
/// about 6·10⁸ r₀ of S₀, r₀ its radius. If not, use the plain engine.
[[nodiscard]] bool can_search(const Problem& problem);

/// The numbers on which the memory of a search depends.
struct SearchSize {
  std::size_t discs = 0;
  std::size_t rays = 0;   ///< in one search
  int threads = 1;        ///< 0: all cores
  bool segments = false;  ///< at least one ray is a segment
  /// powers are summed, because rays differ in power, or the caller requests pairs, front-facing hits only, or totals
  bool sums = true;
  bool powers = true;      ///< powers of single rays are kept (needs_powers)
  double error_bytes = 0;  ///< for each disc: of sums over earlier blocks of photons, and of standard errors
  bool own_totals = true;  ///< the search fills in the outcome's hits and irradiance
};

[[nodiscard]] SearchSize size_of(const Problem& problem, const RunOptions& options);

/// The numbers on which the memory of a box tree depends, as in DiscTree.
struct TreeSize {
  double binary_nodes = 0;
  double nodes = 0;
  ListCapacity lists = {};
};

/// The expected size of the tree, if leaves are half full and a child's box has fan_out^(-2/3) of its parent's surface.
/// If discs are concentrated in a few cells, there may be more nodes; make_disc_tree checks their memory while it
/// writes them.
[[nodiscard]] TreeSize expected_tree(std::size_t discs, const BoxTreeParameters& parameters);

/// Predicted peak bytes of a search: sorted discs and their tree, lists of rays, sums, outcome. Not included are the
/// problem's rays and discs, nor pairs and the copy for a stopped run, which are checked when they are allocated.
///
/// The sizes of arrays are known, except for culled lists, whose number of rays is random. These are predicted for
/// isotropic lines, uniform through S₀. Rays that are concentrated in one place need more: a thread checks again before
/// its lists grow. Untouched pages, and memory that the heap keeps of freed arrays, are not included. The searches
/// throw std::length_error, naming the bytes, if the memory does not suffice.
[[nodiscard]] double boxes_bytes(const SearchSize& size, const TreeSize& tree);

/// Predicted peak bytes of brute force (prepare_all), in addition to rays, discs and pairs.
[[nodiscard]] double all_bytes(const SearchSize& size);

/// Predicted peak bytes of search_walk, in addition to rays, discs and pairs, and including sorting before it.
[[nodiscard]] double walk_bytes(const SearchSize& size, const ListCapacity& lists);

/// Number of rays for which the nested lists of one thread have room, touched or not.
[[nodiscard]] std::size_t list_rays(const SearchSize& size, const ListCapacity& lists);

/// Rays that will be in these lists at once at the least, as far as is known: of ListCapacity::all, thirteen searches used 0.49 to 1.9.
[[nodiscard]] std::size_t least_list_rays(const SearchSize& size, const ListCapacity& lists);

/// The input of a search: a problem's rays, and its discs in an order or in a tree.
struct SearchInput {
  const Problem& problem;
  const Frame& frame;
  const DiscTree& tree;
};

/// The index of brute force: tests every ray against every disc. (Rays that load_rays leaves out count as tested.)
[[nodiscard]] std::unique_ptr<Index> prepare_all(const Problem& problem, const RunOptions& options);

/// Finds the hits of all rays, by culling lists down a tree of boxes. Gives the same bytes for any number of threads.
void search_boxes(const SearchInput& input, const RunOptions& options, Outcome& outcome);

/// The float version of search_along (lists/plain/walk_search.hpp): finds the hits of all rays, with lists that follow
/// the discs in the tree's order. The results have the same bytes for any number of threads.
///
/// Each class of rays has its own walk in each block, so at most as many threads as classes search. Visits and culls
/// are counted once per block. Tests and listed rays are those of one walk over all rays, plus rays that miss a sphere
/// by less than the margin and some segments that end before the sphere (kernels-inl.hpp). `room` is the expected size
/// of the lists.
void search_walk(const SearchInput& input, const MakeWalk& make_walk, const ListCapacity& room,
                 const RunOptions& options, Outcome& outcome);

}  // namespace detp::sim::stream
