#pragma once

#include <optional>

#include "block_search.hpp"
#include "load_rays.hpp"

namespace detp::sim::stream {

/// What has been found so far, disc by disc in the order of a DiscTree.
///
/// Where all rays of a block carry the same power, hits are only counted; their powers are added up when that changes
/// or at the end, one after another as ever.
class Gathering {
 public:
  /// Borrows all three. Goes on with the options' totals, if there are any.
  Gathering(const Problem& problem, const DiscTree& tree, const RunOptions& options);

  /// What the search of a block of such rays needs.
  [[nodiscard]] BlockSearch begin(const Frame& frame, std::size_t first_ray, const RayTraits& traits);

  /// Fills in the outcome: hits, irradiance, pairs, and what the workers counted.
  template <class Workers>
  void give(Workers& workers, Outcome& outcome) {
    for (Worker& worker : workers) {
      outcome.pairs.insert(outcome.pairs.end(), worker.pairs.begin(), worker.pairs.end());
      for (const auto term : {&Counts<std::uint64_t>::sphere_tests, &Counts<std::uint64_t>::disc_tests,
                              &Counts<std::uint64_t>::copies, &Counts<std::uint64_t>::rebuilds})
        outcome.counts.*term += worker.counts.*term;
    }
    finish_outcome(outcome);
  }

 private:
  void finish_outcome(Outcome& outcome);
  void need_totals();
  void add_up();
  void give_counted(Outcome& outcome) const;
  std::uint64_t give_counted(std::size_t first, std::size_t last, Outcome& outcome) const;
  void give_totals(Outcome& outcome);

  const Problem& problem_;
  const DiscTree& tree_;
  const RunOptions& options_;
  Totals totals_;                        ///< empty as long as hits have only been counted
  std::vector<ClassCounts> hits_;        ///< not yet in the totals
  std::optional<double> counted_power_;  ///< what each of those carries; nothing if their powers are in the totals
  std::uint64_t found_ = 0;              ///< hits in the totals that were not there at first
};

}  // namespace detp::sim::stream
