#pragma once

#include <algorithm>

#include "detp/sim/dominant_axis.hpp"
#include "detp/sim/predicates.hpp"
#include "technique.hpp"

namespace detp::sim {

/// Counts what a technique does, or nothing: then a count costs nothing.
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

/// Whether the ray counts as a hit of the disc: the canonical predicate, and the problem's wish for a face.
[[nodiscard]] inline bool counts_as_hit(const Problem& problem, const Ray& ray, const Disc& disc) {
  return hits(ray, disc) && (!problem.front_facing || arrives_in_front(ray, disc));
}

/// Decides by the canonical predicate, and keeps what was hit.
///
/// Every technique must show it the rays of one disc and one dominant axis in rising order of their index: then powers
/// are summed in the same order by all, and irradiance is the same to the last bit.
class HitCollector {
 public:
  /// Borrows the problem, and the options' totals if there are any.
  HitCollector(const Problem& problem, const RunOptions& options)
      : problem_(problem), keep_pairs_(options.pairs), shared_(options.totals) {
    if (totals().empty()) totals().resize(problem.discs.size());
  }

  [[nodiscard]] bool decide(const Ray& ray, const Disc& disc) const { return counts_as_hit(problem_, ray, disc); }

  void keep(std::uint32_t ray, std::uint32_t disc) {
    const Ray& kept = problem_.rays[ray];
    DiscTotals& sums = totals()[disc];
    ++sums.hits;
    sums.power[dominant_axis(kept.direction)] += kept.power;
    ++kept_;
    if (keep_pairs_) pairs_.push_back({ray, disc});
  }

  /// Moves what was found into the outcome: powers become irradiance, unless the totals are another's.
  void give(Outcome& outcome) && {
    std::sort(pairs_.begin(), pairs_.end());
    outcome.pairs = std::move(pairs_);
    outcome.total_hits = kept_;
    outcome.counts.hits = kept_;
    if (shared_ == nullptr) finish(own_, problem_.discs, outcome);
  }

 private:
  [[nodiscard]] Totals& totals() { return shared_ == nullptr ? own_ : *shared_; }

  const Problem& problem_;
  bool keep_pairs_;
  Totals* shared_;
  Totals own_;
  std::uint64_t kept_ = 0;
  std::vector<Pair> pairs_;
};

}  // namespace detp::sim
