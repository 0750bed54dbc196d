#pragma once

#include "pilot.hpp"

/// Compares the box trees of a pilot with the other techniques.
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
[[nodiscard]] Piloted priced(const Candidate& candidate, const Counts<double>& counts, const Counts<double>& error,
                             const Prices& prices);

[[nodiscard]] bool is_allowed(Technique technique, const PilotOptions& options);

/// Compares every exact technique other than box-tree and brute-force with `found`, the fastest of which comes first. Adds to its
/// candidates, techniques ruled out and techniques not examined, as choose_by_pilot says.
void compare_others(const sim::Problem& problem, const SearchSize& size, const Prices& prices,
                    const PilotOptions& options, PilotChoice& found);

}  // namespace detp::validate
