#pragma once

#include "detp/sim/technique/totals.hpp"
#include "disc_tree.hpp"
#include "ray_list.hpp"

/// What the searches share while they find the hits of one block of rays.
namespace detp::sim::stream {

/// Hits of one disc by rays of each class.
using ClassCounts = std::array<std::uint32_t, classes>;

/// A node with fewer tests to make than this is not worth tasks of its own.
inline constexpr std::size_t least_work = std::size_t{1} << 16;

/// What all threads read while a block of rays is searched for.
struct BlockSearch {
  const Problem& problem;
  const Frame& frame;
  const DiscTree& tree;
  std::uint32_t first_ray;  ///< the block's
  bool segments;            ///< its lists tell where rays end
  bool pairs;               ///< wanted
  ClassCounts* hits;        ///< in the discs' order here; what is of one disc and one class is written by one thread
  DiscTotals* totals;       ///< likewise: powers are summed here; null where hits need only be counted
  std::stop_token stop;
};

/// What one thread has of its own.
struct Worker {
  ListArena lists;
  std::vector<Pair> pairs;
  Counts<std::uint64_t> counts;
};

}  // namespace detp::sim::stream
