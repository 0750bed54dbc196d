#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/model/vocabulary/form.hpp"
#include "detp/validate/statistics/statistics.hpp"
#include "point.hpp"

/// Deviations of predicted from observed counts, over a sweep of workloads.
namespace detp::validate {

struct Deviation {
  int dimension = 3;
  double samples = 0;       ///< n_P
  double disc_share = 0;    ///< d/r₀
  std::string technique;    ///< "sphere-cache"
  std::string parameters;   ///< "Q 0.65, k 9"
  std::string quantity;     ///< name of a term of Counts, or "m_i" or "L_i" of sphere i
  std::int64_t sphere = 0;  ///< i; 0 for a term of Counts
  Form form = Form::corrected;
  double predicted = 0;
  Estimate observed;  ///< mean over sets of samples, with its standard error

  [[nodiscard]] double relative() const { return predicted / observed.mean - 1; }
  [[nodiscard]] double relative_error() const { return observed.standard_error / observed.mean; }
};

/// The largest relative deviations allowed.
struct Goal {
  double worst = 0;   ///< of any comparison
  double median = 0;  ///< median over the comparisons
};

/// All comparisons of one quantity of one technique with one form of the formulas.
struct DeviationSummary {
  std::string technique;
  std::string quantity;
  Form form = Form::corrected;
  Goal goal;
  std::size_t compared = 0;  ///< comparisons with a small enough standard error
  std::size_t noisy = 0;     ///< comparisons left out, because their standard error exceeds a quarter of the goal
  std::size_t beyond = 0;    ///< comparisons whose deviation exceeds goal.worst by more than three standard errors
  double median = 0;         ///< of |predicted/observed - 1|, like p95 and worst
  double p95 = 0;
  double worst = 0;
  Deviation worst_at;

  [[nodiscard]] bool met() const { return beyond == 0 && median <= goal.median; }
};

[[nodiscard]] Goal goal_of(const Deviation& deviation);

/// One summary for each technique, quantity and form, in the order of their first appearance.
[[nodiscard]] std::vector<DeviationSummary> summarise(std::span<const Deviation> deviations);

/// Runs every candidate of a point on all sets of the point. Returns the comparisons of formula and count, one for each
/// form of the formulas: of each term of Counts, and of m_i (rebuilds) and L_i (mean rays in the list) of each sphere i
/// with at least 30 rebuilds. The result depends only on the point and the seed. Returns nothing if a stop was
/// requested.
[[nodiscard]] std::vector<Deviation> measure_point(const SweepPoint& point, std::uint64_t seed,
                                                   const std::stop_token& stop);

}  // namespace detp::validate
