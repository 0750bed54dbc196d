#pragma once

#include <algorithm>
#include <optional>

#include "block_search.hpp"
#include "ray_blocks.hpp"

namespace detp::sim::stream {

/// What has been found so far, disc by disc in the order of a DiscTree.
///
/// Where all rays of a block carry the same power, hits are only counted; their powers are added up when that changes
/// or at the end, in ray order as usual.
///
/// A stop request ends a block when some discs have been searched and others not. What is given is then what there was
/// after an earlier block, of which a copy is kept now and then; or, of a single block, the discs searched.
class Gathering {
 public:
  /// Borrows all three. Goes on with the options' totals, if there are any.
  Gathering(const Problem& problem, const DiscTree& tree, const RunOptions& options);

  /// What the search of a block of such rays needs.
  [[nodiscard]] BlockSearch begin(const Frame& frame, std::size_t first_ray, const RayTraits& traits);

  /// After the search of a block.
  template <class Workers>
  void end(const Block& block, const Workers& workers) {
    const bool skipped =
        options_.stop.stop_requested() &&
        std::any_of(workers.begin(), workers.end(), [](const Worker& w) { return !w.skipped.empty(); });
    if (skipped) return end_partly(block);
    std::uint64_t tests = 0;
    for (const Worker& worker : workers) tests += worker.counts.sphere_tests + worker.counts.disc_tests;
    end_wholly(block, tests);
  }

  /// Fills in the outcome: hits, irradiance, pairs, and what the workers counted.
  template <class Workers>
  void give(Workers& workers, Outcome& outcome) {
    std::vector<DiscRun> skipped;
    for (Worker& worker : workers) {
      skipped.insert(skipped.end(), worker.skipped.begin(), worker.skipped.end());
      if (rays_ == problem_.rays.size())
        outcome.pairs.insert(outcome.pairs.end(), worker.pairs.begin(), worker.pairs.end());
      for (const auto term : {&Counts<std::uint64_t>::sphere_tests, &Counts<std::uint64_t>::disc_tests,
                              &Counts<std::uint64_t>::copies, &Counts<std::uint64_t>::rebuilds})
        outcome.counts.*term += worker.counts.*term;
    }
    finish_outcome(skipped, outcome);
  }

 private:
  /// What had been found when so many of the first rays had been searched.
  struct Found {
    std::size_t rays = 0;
    std::uint64_t hits = 0;
    Totals totals = {};
    std::vector<ClassCounts> counts = {};
    std::optional<double> counted_power = {};
    std::uint64_t in_totals = 0;
  };

  void end_wholly(const Block& block, std::uint64_t tests);
  void end_partly(const Block& block);
  void keep();
  [[nodiscard]] std::uint64_t hits() const;
  void go_back();
  void mark_done(std::span<const DiscRun> skipped, Outcome& outcome) const;
  void finish_outcome(std::span<const DiscRun> skipped, Outcome& outcome);
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
  std::size_t rays_ = 0;                 ///< the first so many have been searched for all discs
  bool partial_ = false;                 ///< some discs have been searched for more of them
  bool by_discs_ = false;                ///< … for all of them
  std::uint64_t tests_when_kept_ = 0;
  Found kept_;
  HitBatches batches_;
};

}  // namespace detp::sim::stream
