#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "detp/validate/statistics/statistics.hpp"

/// How far formulas are from what was counted, over a sweep of workloads.
namespace detp::validate {

/// One count, predicted and observed.
struct Deviation {
  int dimension = 3;
  double samples = 0;       ///< n_P
  double disc_share = 0;    ///< d/r₀
  std::string technique;    ///< "sphere-cache"
  std::string parameters;   ///< "Q 0.65, k 9"
  std::string quantity;     ///< a term of Counts for the whole run, or "m_i" or "L_i" of one sphere
  std::int64_t sphere = 0;  ///< i; 0: the whole run
  std::string tier;         ///< "published" or "corrected"
  double predicted = 0;
  Estimate observed;  ///< mean over sets of samples, and its standard error

  [[nodiscard]] double relative() const { return predicted / observed.mean - 1; }
  [[nodiscard]] double relative_error() const { return observed.standard_error / observed.mean; }
};

/// What is wanted of a quantity: largest relative deviations, of any and of the median comparison.
struct Goal {
  double worst = 0;
  double median = 0;
};

/// All comparisons of one quantity of one technique by one tier.
struct DeviationSummary {
  std::string technique;
  std::string quantity;
  std::string tier;
  Goal goal;
  std::size_t compared = 0;  ///< comparisons that were observed closely enough
  std::size_t noisy = 0;     ///< those left out: their standard error exceeds a quarter of the goal
  std::size_t beyond = 0;    ///< farther off than the goal by more than three standard errors
  double median = 0;         ///< of |predicted/observed - 1|, as all that follow
  double p95 = 0;
  double worst = 0;
  Deviation worst_at;

  [[nodiscard]] bool met() const { return beyond == 0 && median <= goal.median; }
};

/// The goal of a quantity.
[[nodiscard]] Goal goal_of(const Deviation& deviation);

/// One summary for each technique, quantity and tier, in the order of their first appearance.
[[nodiscard]] std::vector<DeviationSummary> summarise(std::span<const Deviation> deviations);

}  // namespace detp::validate
