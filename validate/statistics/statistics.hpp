#pragma once

#include <span>
#include <string_view>
#include <utility>
#include <vector>

/// Verdicts by equivalence: a formula agrees when the data show that it is close, not when they fail to show that it is
/// wrong.
namespace detp::validate {

enum class Verdict { agrees, refuted, undecided };

[[nodiscard]] std::string_view name(Verdict verdict);

/// What was counted: a mean and its standard error, >= 0.
struct Estimate {
  double mean = 0;
  double standard_error = 0;
};

/// The value with that share (0 … 1) of the values below it: between the two nearest, in proportion. Throws
/// std::invalid_argument for no values.
[[nodiscard]] double quantile(std::vector<double> values, double share);

/// The one in the middle; of an even number, the mean of the two there.
[[nodiscard]] inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

/// Mean and standard error of independent, equally long batches; at least 2. Throws std::invalid_argument for fewer.
[[nodiscard]] Estimate batch_means(std::span<const double> batches);

/// Ratio of two sums over the same batches, with the standard error by the delta method (linearised).
[[nodiscard]] Estimate batch_ratio(std::span<const double> numerators, std::span<const double> denominators);

/// Half width of the interval, in standard errors, that keeps the chance of any false verdict in a run below `budget`,
/// shared evenly over `comparisons` (Bonferroni): z with 2 (1 - Φ(z)) = budget / comparisons. With few batches the
/// standard error is itself uncertain: Student's t of `batches` - 1 degrees of freedom takes the place of Φ.
[[nodiscard]] double interval_width(double budget, int comparisons, int batches);

/// Judges predicted against observed.
///
///     δ = |observed/predicted - 1|,  w = z SE/|predicted|
///     agrees: δ + w <= tolerance     refuted: δ - w > tolerance     undecided: else
[[nodiscard]] Verdict judge(double predicted, const Estimate& observed, double tolerance, double width);

/// Relative deviation of a formula that would have been refuted with a chance of 97 %: tolerance + (z + 2) SE.
[[nodiscard]] double detectable_deviation(double predicted, const Estimate& observed, double tolerance, double width);

}  // namespace detp::validate
