#pragma once

#include <optional>

#include "detp/sim/geometry/dominant_axis.hpp"
#include "detp/sim/geometry/predicates.hpp"
#include "outcome.hpp"
#include "problem.hpp"
#include "sort_pairs.hpp"

namespace detp::sim {

/// Counts the operations of a technique, or does nothing, at no cost, if counting is off.
template <bool counting>
class Tally {
 public:
  void add(std::uint64_t Counts<std::uint64_t>::*term, std::uint64_t amount = 1) {
    if constexpr (counting) counts_.*term += amount;
  }
  [[nodiscard]] const Counts<std::uint64_t>& counts() const { return counts_; }

 private:
  Counts<std::uint64_t> counts_;
};

/// Whether the ray counts as a hit of the disc, by the canonical predicate and the problem's front_facing.
[[nodiscard]] inline bool counts_as_hit(const Problem& problem, const Ray& ray, const Disc& disc) {
  return hits(ray, disc) && (!problem.front_facing || arrives_in_front(ray, disc));
}

/// Decides by the canonical predicate, and collects the hits.
///
/// For each disc and dominant axis, every technique must pass the rays in rising order of their index. Then all
/// techniques add powers in the same order, and irradiance is the same to the last bit.
class HitCollector {
 public:
  /// Borrows the problem, and the options' totals if there are any.
  HitCollector(const Problem& problem, const RunOptions& options)
      : problem_(problem), keep_pairs_(options.pairs), stop_(options.stop), shared_(options.totals) {
    if (totals().empty()) totals().resize(problem.discs.size());
  }

  [[nodiscard]] bool decide(const Ray& ray, const Disc& disc) const { return counts_as_hit(problem_, ray, disc); }

  void keep(std::uint32_t ray, std::uint32_t disc) {
    const Ray& kept = problem_.rays[ray];
    DiscTotals& sums = totals()[disc];
    ++sums.hits;
    sums.power[dominant_axis(kept.direction)] += kept.power;
    ++kept_;
    if (keep_pairs_) add_pair(pairs_, {ray, disc});
  }

  [[nodiscard]] std::uint64_t kept() const { return kept_; }

  /// Moves what was found into the outcome: powers become irradiance, unless the totals are another's. `rays` of the
  /// problem's first rays have been searched, fewer than all where the search was stopped.
  void give(std::uint64_t rays, Outcome& outcome) && {
    outcome.progress = {rays, problem_.rays.size()};
    outcome.stopped = rays < problem_.rays.size() || !sort_pairs(pairs_, stop_);
    outcome.bytes += grown_bytes(pairs_.size(), sizeof(Pair));
    if (!outcome.stopped) outcome.pairs = std::move(pairs_);
    outcome.total_hits = kept_;
    outcome.counts.hits = kept_;
    if (outcome.batches.count == 0 && rays > 0) outcome.batches.add(rays, kept_);
    if (shared_ == nullptr) finish(own_, problem_.discs, outcome);
  }

  /// For a search that processes one disc after another. Must be called before give_discs.
  void take_discs() {
    if (shared_ != nullptr) before_ = *shared_;
  }

  /// The same of a search that was stopped when all rays had been tested against these discs. Totals of another's are
  /// as they were before: they could not be told to lack some discs.
  void give_discs(std::span<const std::uint32_t> done, Outcome& outcome) && {
    outcome.stopped = true;
    if (shared_ != nullptr) {
      *shared_ = std::move(*before_);
      outcome.progress = {0, problem_.rays.size()};
      return;
    }
    finish(own_, problem_.discs, outcome);
    outcome.done_discs.assign(problem_.discs.size(), false);
    for (const std::uint32_t disc : done) outcome.done_discs[disc] = true;
    keep_done_discs(outcome);
  }

 private:
  [[nodiscard]] Totals& totals() { return shared_ == nullptr ? own_ : *shared_; }

  const Problem& problem_;
  bool keep_pairs_;
  std::stop_token stop_;
  Totals* shared_;
  std::optional<Totals> before_;  ///< the shared totals at first
  Totals own_;
  std::uint64_t kept_ = 0;
  std::vector<Pair> pairs_;
};

}  // namespace detp::sim
