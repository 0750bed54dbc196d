#pragma once

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/search/outcome.hpp"
#include "detp/sim/search/totals.hpp"
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
  bool vectors;             ///< to be counted
  ClassCounts* hits;        ///< in the discs' order here; what is of one disc and one class is written by one thread
  DiscTotals* totals;       ///< likewise: powers are summed here; null where hits need only be counted
};

/// Tests of a ray against a box, a sphere or a disc that make a unit of work (StopCheck): those of a vector.
inline constexpr std::size_t tests_a_unit = 16;

/// Units of work of testing a list of rays `times`.
[[nodiscard]] constexpr std::uint64_t test_work(std::size_t rays, std::size_t times = 1) {
  return rays * times / tests_a_unit + 1;
}

/// What one thread has of its own.
struct Worker {
  /// Lists are expected to take so many floats.
  explicit Worker(std::stop_token stop = {}, std::size_t floats = 0)
      : lists(floats), check(std::move(stop), "searching") {}

  ListArena lists;
  std::vector<Pair> pairs;
  Counts<std::uint64_t> counts;
  Vectors vectors;
  StopCheck check;
  std::vector<DiscRun> skipped;  ///< discs not, or not wholly, searched in the last block, because of a stop request
};

}  // namespace detp::sim::stream
