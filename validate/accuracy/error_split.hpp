#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "detp/validate/statistics/statistics.hpp"

/// The error of an estimate of irradiance, split into noise and bias.
namespace detp::validate {

/// Irradiance at samples, and the variances of these values.
struct ReferenceValues {
  std::span<const double> irradiance;
  std::span<const double> variance;
  std::span<const double> weights = {};  ///< by area, with sum 1; none: equal
  double judged_share = 1;               ///< of the samples in question: errors are for all of these
};

/// Errors of one run, relative to the root mean square irradiance B of the reference. Each is a mean over the samples with its
/// standard error: over all runs, all references and all subsets of the samples in question.
struct ErrorSplit {
  Estimate noise_squared;   ///< variance
  Estimate bias_squared;    ///< may be below 0: it is an estimate without bias
  Estimate total_squared;   ///< expected square error of one run: the sum
  Estimate mean_bias;       ///< signed, relative to the mean irradiance: light that is gained or lost
  double by_reference = 0;  ///< variance of bias_squared that comes from the reference
  double noise_terms = 0;   ///< so many equal squares of one run at one sample would add up to the noise
};

/// From R runs (replicates), each with its own seeds:
///
///     m_i = mean of the runs,  s_i² their variance          noise² = Σ w_i s_i²/B²
///     bias² = Σ w_i q_i/B²     q_i = (m_i - b_i)² - s_i²/R - v_i       total² = noise² + bias²
///     mean bias = Σ w_i (m_i - b_i)/Σ w_i b_i
///
///   where  b_i, v_i   reference at sample i and its variance;  B² = Σ w_i (b_i² - v_i)
///
/// Variances are sums of three: by the jackknife over the runs; of the reference, for the bias Σ w_i² (4 q_i v_i + 2 v_i²); and, if
/// there are more samples in question than judged, that of q_i between samples, above what runs and references explain. The square
/// root of bias² is a bias without the spread of the runs: a root of a sum of squares that contained it would grow with noise.
///
/// Throws std::invalid_argument for fewer than 3 runs, arrays of different lengths, values that are not finite, and a reference that is
/// 0 everywhere.
[[nodiscard]] ErrorSplit split_error(std::span<const std::vector<double>> runs, const ReferenceValues& reference);

/// A value, as the root of a square, and its interval of about 95 %.
struct RootInterval {
  double value = 0;
  double low = 0;
  double high = 0;

  [[nodiscard]] double half_width() const { return 0.5 * (high - low); }
};
/// 0 if the square is below 0; by Student's t for `runs` - 1 degrees of freedom.
[[nodiscard]] RootInterval root_of(const Estimate& square, std::size_t runs);

/// bias² of estimates with discs of radius d, relative to their mean square, from R ≥ 3 runs of independent photons at the same discs with
/// radius d (`wide`) and d/2 (`narrow`):
///
///     bias(d) = c (E(d) - E(d/2))   c = 2 if the bias grows as d (edges), 4/3 if it grows as d² (smooth light)
///
/// Its mean is that of both c; its standard error has their difference, and the jackknife over the runs. Blur that both radii share is
/// not seen. `weights` of the discs, with sum 1. Throws std::invalid_argument for fewer runs, and if no light meets the discs.
[[nodiscard]] Estimate bias_by_two_radii(std::span<const std::vector<double>> wide,
                                         std::span<const std::vector<double>> narrow, std::span<const double> weights);

}  // namespace detp::validate
