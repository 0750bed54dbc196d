#pragma once

#include <cstdint>
#include <span>

#include "detp/sim/base/sorted_runs.hpp"
#include "detp/sim/geometry/disc_source.hpp"
#include "detp/sim/ranks/ranks.hpp"
#include "detp/sim/search/irradiance.hpp"

namespace detp::sim {

/// The discs of a part, and their numbers among all discs, rising.
struct PartOfDiscs {
  std::vector<std::uint32_t> numbers;
  std::vector<Disc> discs;
};

/// What searches for parts of the discs have found. Need not fit in memory (SpillFile).
class PartResults {
 public:
  PartResults(bool errors, std::size_t bands) : errors_(errors), largest_powers_(bands) {}

  /// `totals`: of all rays and the part's discs. `pairs`: sorted, with the discs' numbers among all.
  void add(const PartOfDiscs& part, const Totals& totals, std::span<const Pair> pairs);
  [[nodiscard]] std::size_t bands() const { return largest_powers_.size(); }
  /// Of all photons that met these discs, by band.
  [[nodiscard]] std::span<const double> largest_powers() const { return largest_powers_; }

  /// To another rank, which receives it.
  void send(Ranks& ranks, int to) const;
  void receive(Ranks& ranks, int from);

  /// When all parts are here: the largest power that one photon brought to a disc, by band, the number of photons, and the scale of powers.
  void finish(std::span<const double> heaviest, std::uint64_t photons, double scale);

  [[nodiscard]] bool errors() const { return errors_; }
  [[nodiscard]] std::uint64_t discs() const { return sums_.size() / bands(); }
  [[nodiscard]] std::uint64_t pairs() const { return pairs_.size(); }
  /// Calls visit(std::span<const DiscResult> by_band) for all discs, in the order of their numbers.
  template <class Visit>
  void for_each_disc(const Visit& visit) const {
    typename SortedRuns<Sums>::Reader sums(sums_);
    typename SortedRuns<Errors>::Reader errors(error_sums_);
    Sums one;
    Errors error;
    std::vector<DiscResult> results;
    while (sums.next(one)) {
      const double heaviest = heaviest_.at(results.size());
      results.push_back(result_of(one.sums, errors.next(error) ? &error.sums : nullptr, heaviest, photons_, scale_));
      if (results.size() < bands()) continue;
      visit(std::span<const DiscResult>(results));
      results.clear();
    }
  }
  /// Calls visit(Pair) for all pairs, sorted.
  template <class Visit>
  void for_each_pair(const Visit& visit) const {
    typename SortedRuns<Pair>::Reader pairs(pairs_);
    Pair pair{};
    while (pairs.next(pair)) visit(pair);
  }

 private:
  /// Of the disc with the number place / bands in the band place % bands.
  struct Sums {
    std::uint64_t place = 0;
    FoundSums sums;
    bool operator<(const Sums& other) const { return place < other.place; }
  };
  struct Errors {
    std::uint64_t place = 0;
    ErrorSums sums;
    bool operator<(const Errors& other) const { return place < other.place; }
  };

  bool errors_;
  SortedRuns<Sums> sums_;
  SortedRuns<Errors> error_sums_;
  SortedRuns<Pair> pairs_;
  std::vector<double> largest_powers_;
  std::vector<double> heaviest_;
  double photons_ = 0;
  double scale_ = 1;
};

}  // namespace detp::sim
