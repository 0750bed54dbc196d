#pragma once

#include <span>
#include <string_view>
#include <utility>
#include <vector>

/// Verdicts by equivalence. A formula agrees if the data show that it is close; it is not enough that they fail to show
/// that it is wrong.
namespace detp::validate {

enum class Verdict { agrees, refuted, undecided };

[[nodiscard]] std::string_view name(Verdict verdict);

/// A counted quantity: its mean and standard error, >= 0.
struct Estimate {
  double mean = 0;
  double standard_error = 0;
};

/// The quantile: a share `share` (0 … 1) of the values lies below it. Interpolates linearly between the two nearest
/// values. Throws std::invalid_argument if there are no values.
[[nodiscard]] double quantile(std::vector<double> values, double share);

/// The middle value; of an even number of values, the mean of the two in the middle.
[[nodiscard]] inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

/// Mean and standard error of at least 2 independent, equally long batches. Throws std::invalid_argument for fewer.
[[nodiscard]] Estimate batch_means(std::span<const double> batches);

/// Ratio of two sums over the same batches, with its standard error by the delta method (linearised).
[[nodiscard]] Estimate batch_ratio(std::span<const double> numerators, std::span<const double> denominators);

/// Half width of the interval, in standard errors, that keeps the probability of any false verdict in a run below
/// `budget`. The budget is shared evenly over `comparisons` (Bonferroni): z with 2 (1 - Φ(z)) = budget / comparisons.
/// With few batches the standard error is itself uncertain: Φ is then replaced by Student's t with `batches` - 1
/// degrees of freedom.
[[nodiscard]] double interval_width(double budget, int comparisons, int batches);

/// Compares predicted with observed.
///
///     δ = |observed/predicted - 1|,  w = z SE/|predicted|
///     agrees: δ + w <= tolerance     refuted: δ - w > tolerance     undecided: otherwise
[[nodiscard]] Verdict judge(double predicted, const Estimate& observed, double tolerance, double width);

/// The relative deviation of a formula that would be refuted with a probability of 97 %: tolerance + (z + 2) SE.
[[nodiscard]] double detectable_deviation(double predicted, const Estimate& observed, double tolerance, double width);

}  // namespace detp::validate
