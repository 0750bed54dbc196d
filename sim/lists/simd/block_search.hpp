#pragma once

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/search/outcome.hpp"
#include "detp/sim/search/totals.hpp"
#include "disc_tree.hpp"
#include "ray_list.hpp"

/// Shared data of the searches for the hits of one block of rays.
namespace detp::sim::stream {

/// Hits of one disc by rays of each class.
using ClassCounts = std::array<std::uint32_t, classes>;

/// What is summed in bands 1, 2, … of the rays' powers.
struct FurtherSums {
  std::size_t bands = 0;
  const double* powers = nullptr;  ///< of the block's rays, a row of `bands` for each
  double* sums = nullptr;          ///< rows of `bands`, for each place and class
  PhotonSums* photons = nullptr;   ///< as BlockSearch::photons, a row of `bands` for each place
  const double* units = nullptr;   ///< as BlockSearch::unit, of each band

  [[nodiscard]] PhotonSums& photons_of(std::size_t place, std::size_t band) const {
    return photons[place * bands + band];
  }
  [[nodiscard]] double* row(std::size_t place, std::size_t k) const { return sums + (place * classes + k) * bands; }
};

/// Data that all threads read during the search of a block of rays.
struct BlockSearch {
  const Problem& problem;
  const Frame& frame;
  const DiscTree& tree;
  std::uint32_t first_ray;  ///< number of the block's first ray
  bool segments;            ///< the block's lists have the rays' ends
  bool pairs;               ///< record pairs
  bool vectors;             ///< count vectors
  ClassCounts* hits;        ///< by place in the tree's order; only one thread writes the element of one disc and class
  DiscTotals* totals;       ///< sums of power, indexed and written like hits; null if hits are only counted
  /// Sums over photons, by place; null unless standard errors are requested and do not follow from numbers of hits.
  PhotonSums* photons = nullptr;
  const double* powers = nullptr;  ///< of the block's rays; null if hits are only counted
  double unit = 1;                 ///< u of the squares in PhotonSums
  FurtherSums further = {};
};

/// Whether a disc must be tested with the rays of all classes at once (test_all_classes): for sums over photons that have
/// several rays.
[[nodiscard]] inline bool needs_all_classes(const BlockSearch& block) {
  return block.photons != nullptr && block.problem.numbered();
}

/// Number of tests (ray against box, sphere or disc) in a unit of work of StopCheck: about one vector of rays.
inline constexpr std::size_t tests_a_unit = 16;

/// Units of work for testing each ray of a list `times` times.
[[nodiscard]] constexpr std::uint64_t test_work(std::size_t rays, std::size_t times = 1) {
  return rays * times / tests_a_unit + 1;
}

/// The data of one thread.
struct Worker {
  /// There is room for `rays` rays in the thread's lists; the first `touched` will be used.
  explicit Worker(std::pmr::memory_resource* memory = std::pmr::new_delete_resource(), std::stop_token stop = {},
                  std::size_t rays = 0, std::size_t touched = 0)
      : lists(memory, rays, touched),
        pairs(memory),
        check(std::move(stop), "searching"),
        skipped(memory),
        found(memory) {}

  ListArena lists;
  FoundPairs pairs;
  Counts<std::uint64_t> counts;
  Vectors vectors;
  StopCheck check;
  std::pmr::vector<DiscRun>
      skipped;  ///< discs that were not completely searched in the last block, because of a stop request
  std::pmr::vector<std::uint32_t> found;  ///< rays that hit a disc, class by class; only while it is tested
};

}  // namespace detp::sim::stream
