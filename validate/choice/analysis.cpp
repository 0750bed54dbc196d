#include "analysis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "detp/sim/base/floating_point.hpp"
#include "detp/validate/base/search_work.hpp"
#include "detp/validate/measure/measure_all.hpp"
#include "detp/validate/statistics/statistics.hpp"

namespace detp::validate {
namespace {

void take(const Timed& timed, const AnalysisOptions& options, Analysed& one) {
  if (timed.abandoned) {
    one.given_up_after = timed.first_seconds;
    return;
  }
  one.counted = with_bytes_touched(timed.counts, one.candidate, options.engine);
  std::vector<double> seconds = timed.judging.empty() ? timed.selecting : timed.judging;
  if (seconds.empty()) seconds = {timed.first_seconds};
  const auto [low, high] = std::ranges::minmax_element(seconds);
  one.spread = 0.5 * (*high - *low);
  one.seconds = options.check_seconds + median(std::move(seconds));
}

}  // namespace

Analysis analyse(const sim::Problem& problem, const std::vector<Prediction>& ranking, const AnalysisOptions& options) {
  const sim::DefaultFloatingPoint mode;
  constexpr double patience = 5;  // times the shortest time so far
  std::vector<Contender> asked;
  for (const Prediction& one : ranking) asked.push_back({one.candidate, one.threads});
  const Exhaustive found = measure_all(problem, asked,
                                       {.repeats = options.repeats,
                                        .patience = patience,
                                        .patience_if_asked = patience,
                                        .least_patience = 0.02,
                                        .threads = options.threads,
                                        .vary_threads = false,
                                        .rounds_of_neighbours = 1,
                                        .engine = options.engine,
                                        .disabled = options.disabled,
                                        .stop = options.stop,
                                        .progress = options.progress});
  Analysis all{.candidates = {}, .tried = static_cast<int>(found.candidates.size()), .best = {}, .regret = {}};
  for (const Prediction& one : ranking)
    all.candidates.push_back({.candidate = one.candidate, .threads = one.threads, .predicted = one});
  const auto row_of = [&](const Contender& contender) -> Analysed& {
    const auto same = std::ranges::find_if(all.candidates, [&](const Analysed& one) {
      return one.candidate == contender.candidate && one.threads == contender.threads;
    });
    if (same != all.candidates.end()) return *same;
    return all.candidates.emplace_back(Analysed{.candidate = contender.candidate, .threads = contender.threads});
  };
  for (const Timed& timed : found.candidates) take(timed, options, row_of(timed.contender));
  for (const Refused& refused : found.refused) row_of(refused.contender).refused = refused.reason;
  for (std::size_t i = 0; i < all.candidates.size(); ++i)
    if (const auto& seconds = all.candidates[i].seconds;
        seconds && (!all.best || *seconds < *all.candidates[*all.best].seconds))
      all.best = i;
  if (all.best && all.candidates.front().seconds) {
    const Analysed& choice = all.candidates.front();
    const Analysed& best = all.candidates[*all.best];
    all.regret = *choice.seconds / *best.seconds - 1;
    if (*all.best != 0) all.regret_error = std::hypot(choice.spread, best.spread) / *best.seconds;
  }
  all.stopped = options.stop.stop_requested();
  return all;
}

PredictionError prediction_error(const Prediction& predicted, const Counts<std::uint64_t>& counted, double seconds,
                                 const CostTable& costs) {
  const Counts<double> found = as_expected(counted);
  const Technique technique = predicted.candidate.technique;
  const double counted_seconds = price(found, costs, technique, predicted.threads).again();
  PredictionError error{.seconds = predicted.time.again() / seconds,
                        .counts = predicted.time.again() / counted_seconds,
                        .unit_costs = counted_seconds / seconds,
                        .worst = {}};
  double most = -1;
  for (const auto& [name, term] : count_terms<double>) {
    const double expected = predicted.counts.*term;
    Counts<double> difference;
    difference.*term = std::abs(expected - found.*term);
    const double weight = price(difference, costs, technique).total();
    if (!(weight > most)) continue;
    most = weight;
    error.worst = name;
    error.worst_ratio = expected == found.*term ? 1
                        : found.*term > 0       ? expected / found.*term
                                                : std::numeric_limits<double>::infinity();
  }
  return error;
}

}  // namespace detp::validate
