#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "regret.hpp"

/// The regret of tiers and baselines over many workloads.
namespace detp::validate {

struct Figures {
  std::size_t rows = 0;  ///< number of ratios; if it is 0, the other figures have no meaning
  double geometric_mean = 1;
  double p95 = 1;  ///< the quantile 0.95
  double worst = 1;
  std::size_t at_least = 0;  ///< number of ratios that are lower bounds; unless 0, the figures are lower bounds, too
};

/// The figures of these ratios, all > 0.
[[nodiscard]] Figures figures_of(std::span<const Regret> ratios);

/// The figures over all workloads, and over those that are fitted and held out (BenchWorkload::held_out).
struct RegretFigures {
  Figures all;
  Figures fitted;
  Figures held_out;
};

/// Relative errors |predicted - measured| / measured of the predicted seconds of choices that were not abandoned.
struct PredictionFigures {
  std::size_t rows = 0;  ///< if it is 0, the other figures have no meaning
  double median_error = 0;
  double p95_error = 0;
};

struct TierSummary {
  std::string tier;
  RegretFigures regret;
  Figures price;  ///< (choosing + run) over the best, where the best takes at least shortest_priced_run
  PredictionFigures prediction;
};

inline constexpr double shortest_priced_run = 0.005;  ///< seconds

struct BaselineSummary {
  std::size_t option = 0;  ///< index of the candidate with the smallest geometric mean on the fitted workloads
  RegretFigures regret;    ///< with that candidate on all workloads
};

/// The candidate of a baseline, one of baselines(), by its index; nullopt if it depends on the workload.
[[nodiscard]] std::optional<Candidate> candidate_of(std::size_t baseline, const BaselineSummary& summary);

struct RegretSummary {
  int threads = 1;
  std::size_t rows = 0;
  std::vector<TierSummary> tiers;
  std::vector<BaselineSummary> baselines;  ///< in the order of baselines()
  Figures noise;                           ///< of the larger of RegretRow::noise and its reciprocal
};

/// The summary of the rows with `threads` threads. All rows must have the same tiers.
[[nodiscard]] RegretSummary summarise(std::span<const RegretRow> rows, int threads);

/// A choice of a row, by their indices.
struct ChoicePlace {
  std::size_t row = 0;
  std::size_t choice = 0;
};

/// The choices with the largest regrets, worst first, at most `most` of them. Leaves out choices that were the best.
[[nodiscard]] std::vector<ChoicePlace> worst_choices(std::span<const RegretRow> rows, std::size_t most);

}  // namespace detp::validate
