#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "detp/validate/statistics/statistics.hpp"

/// The error of an estimate of irradiance, split into noise and bias.
namespace detp::validate {

/// Irradiance at samples that are spread evenly over the surfaces' area, and the variances of these values.
struct ReferenceValues {
  std::span<const double> irradiance;
  std::span<const double> variance;
};

/// Errors of one run, relative to the root mean square irradiance B of the reference. Each is a mean over the samples with its
/// standard error: for these samples, over all runs and all references.
struct ErrorSplit {
  Estimate noise_squared;    ///< variance
  Estimate bias_squared;     ///< may be below 0: it is an estimate without bias
  Estimate total_squared;    ///< expected square error of one run: the sum
  double share_within = 0;   ///< of the samples with light: error of one run below `within` B
  double error_95 = 0;       ///< 95 % of them have an error of one run below this, over B
  double worst = 0;          ///< largest error of one run, over B
  std::size_t dark = 0;      ///< samples without light
  double light_in_dark = 0;  ///< root mean square of estimates there, over B; 0 if there are none
};

/// From R runs (replicates), each with its own seeds:
///
///     m_i = mean of the runs,  s_i² their variance          noise² = Σ s_i²/(n B²)
///     bias² = Σ ((m_i - b_i)² - s_i²/R - v_i)/(n B²)        total² = noise² + bias²
///
///   where  b_i, v_i   reference at sample i and its variance;  B² = Σ (b_i² - v_i)/n
///
/// Standard errors are those of the jackknife over the runs, and for the bias also 4 Σ (m_i - b_i)² v_i/(n B²)² + 2 Σ v_i²/(n B²)², from
/// the reference. The square root of bias² is a bias without the spread of the runs: a root of a sum of squares that
/// contained it would grow with noise. The last four figures are of single runs and contain the reference's error.
///
/// Throws std::invalid_argument for fewer than 3 runs, arrays of different lengths, values that are not finite, and a reference that is
/// 0 everywhere.
[[nodiscard]] ErrorSplit split_error(std::span<const std::vector<double>> runs, const ReferenceValues& reference,
                                     double within = 0.05);

/// A root of a square and its interval of about 95 %: Student's t for `runs` - 1 degrees of freedom.
struct RootInterval {
  double value = 0;  ///< 0 if the square is below 0
  double low = 0;
  double high = 0;
};
[[nodiscard]] RootInterval root_of(const Estimate& square, std::size_t runs);

}  // namespace detp::validate
