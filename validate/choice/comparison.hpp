#pragma once

#include "choice.hpp"

/// Compares what a sample counted with the other techniques.
namespace detp::validate {

/// The costs, and the most threads for which a choice is made.
struct Prices {
  const Valid<CostTable>& costs;
  int most_threads;

  [[nodiscard]] TimeOnThreads operator()(const Counts<double>& counts, Technique technique) const {
    return fastest_price(counts, costs, technique, most_threads);
  }
};

/// Of a search: how many rays, whether some of them end, how many discs.
struct SearchSize {
  double rays;
  bool segments;
  double discs;
};

/// A candidate with its price and the price's error. `error` has the standard errors of the counts.
[[nodiscard]] Prediction priced(const Candidate& candidate, const Counts<double>& counts, const Counts<double>& error,
                                const Prices& prices);

/// Compares every exact technique other than box-tree and brute-force with `found`, the fastest of which comes first. A
/// technique is ruled out if a search with the least counts that are possible takes longer than the best: each disc sorted,
/// placed and visited once, each ray loaded, each hit tested. (If rays reach few of the discs, a search may visit fewer.)
/// One that this does not rule out is compared by its closed form, if the closed forms and the evidence that they need
/// take less than 2 % of the best, or if `all`; it is ruled out if it takes closed_form_doubt times as long as the best.
/// Leaves the choice first (put_choice_first with `prepared`).
void compare_others(const Question& question, const SearchSize& size, const Prices& prices, bool all, double prepared,
                    Choice& found);

}  // namespace detp::validate
