#include "choose.hpp"

#include <algorithm>

#include "extrapolation.hpp"
#include "predict.hpp"

namespace detp::model {
namespace {

/// The technique's defaults with the values in `fixed`. Throws as set_parameter.
Candidate candidate_with(Technique technique, const FixedParameters& fixed) {
  Candidate candidate = default_candidate(technique);
  for (const auto& [name, value] : fixed.values) set_parameter(candidate, name, value);
  return candidate;
}

bool is_number(const Parameter& parameter) { return parameter.choices.empty(); }

bool are_all_numbers_fixed(const FixedParameters& fixed, Technique technique) {
  const auto& parameters = record_of(technique).parameters;
  return std::all_of(parameters.begin(), parameters.end(), [&](const Parameter& parameter) {
    return !is_number(parameter) || std::any_of(fixed.values.begin(), fixed.values.end(),
                                                [&](const auto& value) { return value.first == parameter.name; });
  });
}

}  // namespace

Ranked assess(const Valid<Workload>& workload, const Valid<Candidate>& candidate, const Valid<CostTable>& costs,
              int most_threads) {
  require_count("number of threads", most_threads, 1, 1e6);
  const Counts<double> counts = predict(workload, candidate, costs.engine);
  const auto fastest = fastest_price(counts, costs, candidate.technique, most_threads);
  return {candidate, counts, fastest.time, extrapolations(workload, candidate), fastest.threads};
}

std::optional<Candidate> complete(Technique technique, const FixedParameters& fixed, const Valid<Workload>& workload,
                                  const Valid<CostTable>& costs, const SearchLimits& limits) {
  Candidate candidate = candidate_with(technique, fixed);
  if (model_of(technique).best == nullptr || are_all_numbers_fixed(fixed, technique)) return candidate;
  SearchLimits of_engine = limits;
  of_engine.engine = costs.engine;
  const auto best = model_of(technique).best(workload, costs_of(costs, technique), fixed, of_engine);
  if (!best) return std::nullopt;
  candidate.parameters = *best;
  for (const auto& [name, value] : fixed.values) set_parameter(candidate, name, value);
  return candidate;
}

std::optional<Ranked> best_of(Technique technique, const Valid<Workload>& workload, const Valid<CostTable>& costs,
                              const SearchLimits& limits) {
  if (!has_closed_form(technique)) return std::nullopt;
  const auto candidate = complete(technique, {}, workload, costs, limits);
  if (!candidate) return std::nullopt;
  const auto* cache = std::get_if<SphereCacheParameters>(&candidate->parameters);
  if (cache != nullptr && cache->spheres == 0) return std::nullopt;  // this is brute force
  return assess(workload, *candidate, costs, limits.threads);
}

std::vector<Ranked> rank(const Valid<Workload>& workload, const Valid<CostTable>& costs, const SearchLimits& limits) {
  std::vector<Ranked> ranking;
  for (const Technique technique : all_techniques) {
    if (!ranking.empty() && limits.stop.stop_requested()) break;
    if (!record_of(technique).exact) continue;
    if (auto best = best_of(technique, workload, costs, limits)) ranking.push_back(std::move(*best));
  }
  std::stable_sort(ranking.begin(), ranking.end(),
                   [](const Ranked& a, const Ranked& b) { return a.time.total() < b.time.total(); });
  return ranking;
}

}  // namespace detp::model
