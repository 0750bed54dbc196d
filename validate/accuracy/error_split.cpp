#include "error_split.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace detp::validate {
namespace {

void require_same_length(std::span<const std::vector<double>> runs, const ReferenceValues& reference) {
  if (runs.size() < 3)
    throw std::invalid_argument(fmt::format("splitting an error needs at least 3 runs (got {})", runs.size()));
  const std::size_t samples = reference.irradiance.size();
  if (samples == 0 || reference.variance.size() != samples ||
      (!reference.weights.empty() && reference.weights.size() != samples))
    throw std::invalid_argument(
        "a reference needs samples, and a variance for each, and a weight if there are weights");
  for (const std::vector<double>& run : runs)
    if (run.size() != samples)
      throw std::invalid_argument(fmt::format(
          "a run has {} irradiances, the reference {}: they must be at the same samples", run.size(), samples));
}

void require_finite_values(std::span<const double> values, const char* what) {
  for (const double value : values)
    if (!std::isfinite(value)) throw std::invalid_argument(fmt::format("{} must be finite (got {})", what, value));
}

/// What the runs say of one sample.
struct OfSample {
  double off = 0;       ///< mean - reference
  double variance = 0;  ///< of one run
};

/// Mean and variance over all runs but number `without` (none if it is too large).
OfSample of_sample(std::span<const std::vector<double>> runs, double reference, std::size_t i, std::size_t without) {
  const auto count = static_cast<double>(runs.size() - (without < runs.size() ? 1 : 0));
  double sum = 0;
  for (std::size_t r = 0; r < runs.size(); ++r) sum += r == without ? 0 : runs[r][i];
  const double mean = sum / count;
  double squares = 0;
  for (std::size_t r = 0; r < runs.size(); ++r) squares += r == without ? 0 : (runs[r][i] - mean) * (runs[r][i] - mean);
  return {mean - reference, squares / (count - 1)};
}

struct Sums {
  double noise = 0;
  double bias = 0;
  double total = 0;
  double mean_bias = 0;
};

class Splitter {
 public:
  Splitter(std::span<const std::vector<double>> runs, const ReferenceValues& reference)
      : runs_(runs),
        reference_(reference),
        weights_(reference.irradiance.size(), 1 / static_cast<double>(reference.irradiance.size())) {
    if (!reference.weights.empty()) weights_.assign(reference.weights.begin(), reference.weights.end());
  }

  [[nodiscard]] double weight(std::size_t i) const { return weights_[i]; }

  /// Weighted sums of all runs but one.
  [[nodiscard]] Sums sums(std::size_t without) const {
    const auto count = static_cast<double>(runs_.size() - (without < runs_.size() ? 1 : 0));
    Sums sums;
    for (std::size_t i = 0; i < size(); ++i) {
      const auto [off, variance] = of_sample(runs_, reference_.irradiance[i], i, without);
      sums.noise += weight(i) * variance;
      sums.bias += weight(i) * (off * off - variance / count - reference_.variance[i]);
      sums.mean_bias += weight(i) * off;
    }
    sums.total = sums.noise + sums.bias;
    return sums;
  }

  /// Variances by the reference, and between the samples of a subset.
  struct Variances {
    double bias_by_reference = 0;
    double bias_by_subset = 0;
    double noise_by_subset = 0;
    double mean_by_reference = 0;
    double mean_by_subset = 0;
  };
  [[nodiscard]] Variances variances(const Sums& all) const {
    const auto runs = static_cast<double>(runs_.size());
    const auto count = static_cast<double>(size());
    const double unseen = (1 - reference_.judged_share) * count / std::max(1.0, count - 1);
    Variances found;
    double by_noise = 0;  // of bias², from the runs' noise as if it were independent between samples
    double mean_by_noise = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      const auto [off, variance] = of_sample(runs_, reference_.irradiance[i], i, runs_.size());
      const double w = weight(i) * weight(i);
      const double v = reference_.variance[i];
      const double s = variance / runs;
      const double square = off * off - s - v;
      const double sure = std::max(0.0, square);
      found.bias_by_reference += w * (4 * sure * v + 2 * v * v);
      by_noise += w * (4 * sure * s + 2 * s * s + 4 * s * v);
      found.mean_by_reference += w * v;
      mean_by_noise += w * s;
      found.bias_by_subset += w * (square - all.bias) * (square - all.bias);
      found.noise_by_subset +=
          w * ((variance - all.noise) * (variance - all.noise) - 2 * variance * variance / (runs - 1));
      found.mean_by_subset += w * (off - all.mean_bias) * (off - all.mean_bias);
    }
    found.bias_by_subset = unseen * std::max(0.0, found.bias_by_subset - by_noise - found.bias_by_reference);
    found.mean_by_subset = unseen * std::max(0.0, found.mean_by_subset - mean_by_noise - found.mean_by_reference);
    found.noise_by_subset = unseen * std::max(0.0, found.noise_by_subset);
    return found;
  }

  /// (Σ c)²/Σ c² of all squares c that the noise of the runs adds up.
  [[nodiscard]] double equal_terms() const {
    double sum = 0;
    double squares = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      double mean = 0;
      for (const std::vector<double>& run : runs_) mean += run[i] / static_cast<double>(runs_.size());
      for (const std::vector<double>& run : runs_) {
        const double square = weight(i) * (run[i] - mean) * (run[i] - mean);
        sum += square;
        squares += square * square;
      }
    }
    return squares > 0 ? sum * sum / squares : 0;
  }

  [[nodiscard]] std::size_t size() const { return weights_.size(); }

 private:
  std::span<const std::vector<double>> runs_;
  const ReferenceValues& reference_;
  std::vector<double> weights_;
};

double jackknife(const std::vector<Sums>& left_out, double Sums::*value) {
  const auto count = static_cast<double>(left_out.size());
  double mean = 0;
  for (const Sums& one : left_out) mean += one.*value / count;
  double squares = 0;
  for (const Sums& one : left_out) squares += (one.*value - mean) * (one.*value - mean);
  return (count - 1) / count * squares;
}

}  // namespace

ErrorSplit split_error(std::span<const std::vector<double>> runs, const ReferenceValues& reference) {
  require_same_length(runs, reference);
  for (const std::vector<double>& run : runs) require_finite_values(run, "an irradiance");
  require_finite_values(reference.irradiance, "a reference's irradiance");
  require_finite_values(reference.variance, "a reference's variance");
  const Splitter splitter(runs, reference);
  double mean_square = 0;
  double mean = 0;
  for (std::size_t i = 0; i < splitter.size(); ++i) {
    const double one = reference.irradiance[i];
    mean_square += splitter.weight(i) * (one * one - reference.variance[i]);
    mean += splitter.weight(i) * one;
  }
  if (!(mean_square > 0)) throw std::invalid_argument("a reference without light has no relative errors");

  const Sums all = splitter.sums(runs.size());
  std::vector<Sums> left_out;
  for (std::size_t r = 0; r < runs.size(); ++r) left_out.push_back(splitter.sums(r));
  const Splitter::Variances variances = splitter.variances(all);
  const double of_bias = variances.bias_by_reference + variances.bias_by_subset;
  const auto relative = [&](double Sums::*value, double more) {
    const double variance = jackknife(left_out, value) + more;
    return Estimate{all.*value / mean_square, std::sqrt(variance) / mean_square};
  };
  ErrorSplit split;
  split.noise_squared = relative(&Sums::noise, variances.noise_by_subset);
  split.bias_squared = relative(&Sums::bias, of_bias);
  split.total_squared = relative(&Sums::total, of_bias + variances.noise_by_subset);
  split.noise_terms = splitter.equal_terms();
  split.by_reference = variances.bias_by_reference / (mean_square * mean_square);
  const double of_mean = jackknife(left_out, &Sums::mean_bias) + variances.mean_by_reference + variances.mean_by_subset;
  if (mean > 0) split.mean_bias = {all.mean_bias / mean, std::sqrt(of_mean) / mean};
  return split;
}

RootInterval root_of(const Estimate& square, std::size_t runs) {
  const double width = interval_width(0.05, 1, static_cast<int>(runs)) * square.standard_error;
  const auto root = [](double value) { return std::sqrt(std::max(0.0, value)); };
  return {root(square.mean), root(square.mean - width), root(square.mean + width)};
}

Estimate bias_by_two_radii(std::span<const std::vector<double>> wide, std::span<const std::vector<double>> narrow,
                           std::span<const double> weights) {
  if (wide.size() < 3 || wide.size() != narrow.size())
    throw std::invalid_argument("a bias by two radii needs at least 3 runs with each");
  const std::size_t discs = weights.size();
  const auto runs = static_cast<double>(wide.size());
  std::vector<double> mean(discs);
  for (const std::vector<double>& run : wide)
    for (std::size_t i = 0; i < discs; ++i) mean[i] += run[i] / runs;
  // The differences are runs whose reference is 0; relative errors need another one.
  std::vector<std::vector<double>> apart;
  for (std::size_t r = 0; r < wide.size(); ++r) {
    std::vector<double>& run = apart.emplace_back(mean);
    for (std::size_t i = 0; i < discs; ++i) run[i] += wide[r][i] - narrow[r][i];
  }
  const std::vector<double> exact(discs, 0.0);
  const ErrorSplit split = split_error(apart, {mean, exact, weights});
  constexpr double least = 16.0 / 9;
  constexpr double most = 4;
  constexpr double middle = 0.5 * (least + most);
  const double spread = 0.5 * (most - least) * std::max(0.0, split.bias_squared.mean) / 1.96;
  return {middle * split.bias_squared.mean, std::hypot(middle * split.bias_squared.standard_error, spread)};
}

}  // namespace detp::validate
