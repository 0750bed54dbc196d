#pragma once

#include <algorithm>
#include <numbers>

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

/// Decides by the canonical predicate, and keeps what was hit.
///
/// Every technique must show it the rays of one disc in rising order of their index: then powers are summed in the same
/// order by all, and irradiance is the same to the last bit.
class HitCollector {
 public:
  HitCollector(const Problem& problem, const RunOptions& options)
      : problem_(problem), keep_pairs_(options.pairs), hits_(problem.discs.size()), power_(problem.discs.size()) {}

  /// Whether the ray counts as a hit of the disc.
  [[nodiscard]] bool decide(const Ray& ray, const Disc& disc) const {
    return hits(ray, disc) && (!problem_.front_facing || arrives_in_front(ray, disc));
  }

  void keep(std::uint32_t ray, std::uint32_t disc) {
    ++hits_[disc];
    power_[disc] += problem_.rays[ray].power;
    if (keep_pairs_) pairs_.push_back({ray, disc});
  }

  /// Moves what was found into the outcome: powers become irradiance.
  void give(Outcome& outcome) && {
    for (std::size_t i = 0; i < power_.size(); ++i) {
      const double radius = problem_.discs[i].radius;
      power_[i] /= std::numbers::pi * radius * radius;
      outcome.total_hits += hits_[i];
    }
    std::sort(pairs_.begin(), pairs_.end());
    outcome.hits = std::move(hits_);
    outcome.irradiance = std::move(power_);
    outcome.pairs = std::move(pairs_);
    outcome.counts.hits = outcome.total_hits;
  }

 private:
  const Problem& problem_;
  bool keep_pairs_;
  std::vector<std::uint64_t> hits_;
  std::vector<double> power_;
  std::vector<Pair> pairs_;
};

}  // namespace detp::sim
