#pragma once

#include <span>
#include <string_view>
#include <utility>
#include <vector>

/// Verdicts by tests of equivalence: a formula agrees only if the data show that its error is within the tolerance.
/// Data that merely fail to show an error do not suffice.
namespace detp::validate {

enum class Verdict { agrees, refuted, undecided };

[[nodiscard]] std::string_view name(Verdict verdict);

/// A counted quantity: its mean and standard error, >= 0.
struct Estimate {
  double mean = 0;
  double standard_error = 0;
};

/// The quantile: the value below which the share `share` of the values lies. Interpolates linearly between the two
/// nearest values. Throws std::invalid_argument if there are no values, or if `share` is not in [0, 1].
[[nodiscard]] double quantile(std::vector<double> values, double share);

/// The middle value, or the mean of the two middle values if their number is even.
[[nodiscard]] inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

/// The median of a[i]/b[i] over the places that both have; NaN if there are none.
[[nodiscard]] double median_ratio(std::span<const double> a, std::span<const double> b);

/// Mean and standard error of at least 2 independent, equally long batches. Throws std::invalid_argument for fewer.
[[nodiscard]] Estimate batch_means(std::span<const double> batches);

/// Ratio of two sums over the same batches, with the standard error of the ratio by the delta method (linearised).
[[nodiscard]] Estimate batch_ratio(std::span<const double> numerators, std::span<const double> denominators);

/// Half width z, in standard errors, of the intervals that keep the probability of any false verdict in a run below
/// `budget`. The budget is shared evenly over `comparisons` (Bonferroni): 2 (1 - Φ(z)) = budget / comparisons. Φ is the
/// distribution of Student's t with `batches` - 1 degrees of freedom, because the standard error is itself uncertain.
/// Throws std::invalid_argument unless 0 < budget < 1, comparisons >= 1 and batches >= 2.
[[nodiscard]] double interval_width(double budget, int comparisons, int batches);

/// The error that test 1, 2, … of a target may make, so that all tests together, however many, err with 1 - `confidence`:
/// (1 - confidence) 2/3ᵗ.
[[nodiscard]] double error_of_test(double confidence, int test);

/// Compares predicted with observed, with z = `width` and SE the standard error of `observed`. Undecided if SE is
/// infinite.
///
///     δ = |observed/predicted - 1|,  w = z SE/|predicted|
///     agrees: δ + w <= tolerance     refuted: δ - w > tolerance     undecided: otherwise
[[nodiscard]] Verdict judge(double predicted, const Estimate& observed, double tolerance, double width);

/// The relative deviation of a formula that would be refuted with a probability of 97 %: `tolerance` + (z + 2)
/// SE/|predicted|, with z and SE as for judge().
[[nodiscard]] double detectable_deviation(double predicted, const Estimate& observed, double tolerance, double width);

}  // namespace detp::validate
