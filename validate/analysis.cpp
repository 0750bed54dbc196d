#include "analysis.hpp"

#include <algorithm>

namespace detp::validate {
namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

/// The candidates worth running, by their place in the ranking.
std::vector<std::size_t> worth_running(const std::vector<model::Ranked>& ranking, double hopeless) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < ranking.size(); ++i)
    if (ranking[i].time.total() <= hopeless * ranking.front().time.total()) places.push_back(i);
  return places;
}

std::optional<double> regret_of_first(const std::vector<Analysed>& candidates) {
  if (candidates.empty() || !candidates.front().seconds) return std::nullopt;
  double fastest = *candidates.front().seconds;
  for (const Analysed& candidate : candidates)
    if (candidate.seconds) fastest = std::min(fastest, *candidate.seconds);
  return fastest > 0 ? *candidates.front().seconds / fastest - 1 : 0;
}

}  // namespace

Analysis analyse(const sim::Problem& problem, const std::vector<model::Ranked>& ranking,
                 const AnalysisOptions& options) {
  Analysis analysis;
  for (const model::Ranked& ranked : ranking) analysis.candidates.push_back({.predicted = ranked});
  const std::vector<std::size_t> places = worth_running(ranking, options.hopeless);
  std::vector<std::vector<double>> seconds(ranking.size());
  for (int round = 0; round <= options.repeats && !analysis.stopped; ++round)
    for (const std::size_t place : places) {
      const Candidate& candidate = ranking[place].candidate;
      if (options.progress) options.progress(name(candidate.technique), round / (options.repeats + 1.0));
      const sim::Outcome outcome = sim::run(problem, candidate, {.count = round == 0, .stop = options.stop});
      analysis.stopped = outcome.stopped;
      if (outcome.stopped) break;
      if (round == 0)
        analysis.candidates[place].counted = outcome.counts;
      else
        seconds[place].push_back(outcome.seconds.total());
    }
  for (std::size_t place = 0; place < ranking.size(); ++place)
    if (!seconds[place].empty()) {
      const auto [low, high] = std::minmax_element(seconds[place].begin(), seconds[place].end());
      analysis.candidates[place].seconds = median(seconds[place]);
      analysis.candidates[place].spread = 0.5 * (*high - *low);
    }
  analysis.regret = regret_of_first(analysis.candidates);
  return analysis;
}

}  // namespace detp::validate
