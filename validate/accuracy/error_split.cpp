#include "error_split.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace detp::validate {
namespace {

void require_same_length(std::span<const std::vector<double>> runs, const ReferenceValues& reference) {
  if (runs.size() < 3)
    throw std::invalid_argument(fmt::format("splitting an error needs at least 3 runs (got {})", runs.size()));
  const std::size_t samples = reference.irradiance.size();
  if (samples == 0 || reference.variance.size() != samples)
    throw std::invalid_argument("a reference needs samples, and a variance for each");
  for (const std::vector<double>& run : runs)
    if (run.size() != samples)
      throw std::invalid_argument(fmt::format(
          "a run has {} irradiances, the reference {}: they must be at the same samples", run.size(), samples));
}

void require_finite_values(std::span<const double> values, const char* what) {
  for (const double value : values)
    if (!std::isfinite(value)) throw std::invalid_argument(fmt::format("{} must be finite (got {})", what, value));
}

struct Squares {
  double noise = 0;
  double bias = 0;

  [[nodiscard]] double total() const { return noise + bias; }
};

/// Sums over all runs but number `without` (none if it is too large), divided by the number of samples.
Squares squares_of(std::span<const std::vector<double>> runs, const ReferenceValues& reference, std::size_t without) {
  const auto count = static_cast<double>(runs.size() - (without < runs.size() ? 1 : 0));
  Squares sums;
  for (std::size_t i = 0; i < reference.irradiance.size(); ++i) {
    double sum = 0;
    for (std::size_t r = 0; r < runs.size(); ++r) sum += r == without ? 0 : runs[r][i];
    const double mean = sum / count;
    double squares = 0;
    for (std::size_t r = 0; r < runs.size(); ++r)
      squares += r == without ? 0 : (runs[r][i] - mean) * (runs[r][i] - mean);
    const double variance = squares / (count - 1);
    const double off = mean - reference.irradiance[i];
    sums.noise += variance;
    sums.bias += off * off - variance / count - reference.variance[i];
  }
  const auto samples = static_cast<double>(reference.irradiance.size());
  return {sums.noise / samples, sums.bias / samples};
}

/// Variance of the squared bias that comes from the reference, times the number of samples squared.
double variance_by_reference(std::span<const std::vector<double>> runs, const ReferenceValues& reference) {
  double sum = 0;
  for (std::size_t i = 0; i < reference.irradiance.size(); ++i) {
    double mean = 0;
    for (const std::vector<double>& run : runs) mean += run[i] / static_cast<double>(runs.size());
    const double off = mean - reference.irradiance[i];
    const double v = reference.variance[i];
    sum += 4 * std::max(0.0, off * off - v) * v + 2 * v * v;
  }
  return sum;
}

/// Errors of single runs at samples with light; estimates at samples without.
void add_single_errors(std::span<const std::vector<double>> runs, const ReferenceValues& reference, double rms,
                       double within, ErrorSplit& split) {
  std::vector<double> errors;
  double dark_squares = 0;
  for (std::size_t i = 0; i < reference.irradiance.size(); ++i) {
    const bool dark = reference.irradiance[i] == 0;
    split.dark += dark ? 1 : 0;
    for (const std::vector<double>& run : runs)
      if (dark)
        dark_squares += run[i] * run[i];
      else
        errors.push_back(std::abs(run[i] - reference.irradiance[i]) / rms);
  }
  if (split.dark > 0)
    split.light_in_dark = std::sqrt(dark_squares / static_cast<double>(split.dark * runs.size())) / rms;
  if (errors.empty()) return;
  const auto inside = std::ranges::count_if(errors, [&](double error) { return error <= within; });
  split.share_within = static_cast<double>(inside) / static_cast<double>(errors.size());
  split.worst = *std::ranges::max_element(errors);
  split.error_95 = quantile(std::move(errors), 0.95);
}

}  // namespace

ErrorSplit split_error(std::span<const std::vector<double>> runs, const ReferenceValues& reference, double within) {
  require_same_length(runs, reference);
  for (const std::vector<double>& run : runs) require_finite_values(run, "an irradiance");
  require_finite_values(reference.irradiance, "a reference's irradiance");
  require_finite_values(reference.variance, "a reference's variance");
  const auto samples = static_cast<double>(reference.irradiance.size());
  double mean_square = 0;
  for (std::size_t i = 0; i < reference.irradiance.size(); ++i)
    mean_square += (reference.irradiance[i] * reference.irradiance[i] - reference.variance[i]) / samples;
  if (!(mean_square > 0)) throw std::invalid_argument("a reference without light has no relative errors");

  const Squares all = squares_of(runs, reference, runs.size());
  std::vector<Squares> left_out;
  for (std::size_t r = 0; r < runs.size(); ++r) left_out.push_back(squares_of(runs, reference, r));
  const auto jackknife = [&](auto value) {
    const auto count = static_cast<double>(runs.size());
    double mean = 0;
    for (const Squares& one : left_out) mean += value(one) / count;
    double squares = 0;
    for (const Squares& one : left_out) squares += (value(one) - mean) * (value(one) - mean);
    return (count - 1) / count * squares;
  };
  const double of_reference = variance_by_reference(runs, reference) / (samples * samples);
  const auto relative = [&](double square, double variance) {
    return Estimate{square / mean_square, std::sqrt(variance) / mean_square};
  };
  ErrorSplit split;
  split.noise_squared = relative(all.noise, jackknife([](const Squares& one) { return one.noise; }));
  split.bias_squared = relative(all.bias, jackknife([](const Squares& one) { return one.bias; }) + of_reference);
  split.total_squared = relative(all.total(), jackknife([](const Squares& one) { return one.total(); }) + of_reference);
  add_single_errors(runs, reference, std::sqrt(mean_square), within, split);
  return split;
}

RootInterval root_of(const Estimate& square, std::size_t runs) {
  const double width = interval_width(0.05, 1, static_cast<int>(runs)) * square.standard_error;
  const auto root = [](double value) { return std::sqrt(std::max(0.0, value)); };
  return {root(square.mean), root(square.mean - width), root(square.mean + width)};
}

}  // namespace detp::validate
