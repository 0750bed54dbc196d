#pragma once

#include <span>
#include <vector>

#include "choice.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"

/// How predictions of different kinds are compared: closed forms, and what a sample counted with the other techniques.
namespace detp::validate {

/// How many times as long as predicted a search may take, in scenes for which its closed form was not made.
inline constexpr double closed_form_doubt = 2;

/// Sets how much each prediction is doubted:
///
///     1                  counts of a sample; brute force, whose tests are exact; box trees, whose closed forms were compared with
///                        real scenes; closed forms that are not extrapolated, compared with other closed forms
///     closed_form_doubt  closed forms that are compared with a sample's counts; or where only numbers are out of range
///     infinite           extrapolated closed forms in scenes of another kind (unless `counted_scene`, model::is_counted_scene),
///                        where tests were off by up to 17 times
///
/// Then sorts them by time, but with the choice first: the one that is fastest even so (the fastest, if all are doubted
/// without limit). A box tree needs `prepared` less than its time, because its discs are sorted already.
void put_choice_first(std::vector<Prediction>& candidates, bool counted_scene, double prepared = 0);

/// Whether the question has a workload, or discs and rays on which it can be measured.
[[nodiscard]] bool can_measure(const Question& question);

/// The question's workload with that number of rays: measured on its rays and discs, unless it has one. For one search that is too short for
/// evidence to pay (sim::evidence_can_pay), the workload with the meanings of the input alone. Throws as sim::set_rays and sim::observe.
[[nodiscard]] Workload evidence(const Question& question, double rays);

/// model::rank without the disabled techniques, the choice first (put_choice_first). model::rank does not tune a technique
/// that is slower than another one; where that one is disabled, this function tunes it. Empty if all are disabled. Throws as
/// model::rank.
[[nodiscard]] std::vector<Prediction> allowed_ranking(const Valid<Workload>& workload, const Valid<CostTable>& costs,
                                                      std::span<const Technique> disabled,
                                                      const model::SearchLimits& limits = {});

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
