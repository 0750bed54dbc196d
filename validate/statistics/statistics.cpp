#include "statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace detp::validate {

std::string_view name(Verdict verdict) {
  switch (verdict) {
    case Verdict::agrees:
      return "agrees";
    case Verdict::refuted:
      return "refuted";
    case Verdict::undecided:
      return "undecided";
  }
  throw std::logic_error("a verdict without a name");
}

double quantile(std::vector<double> values, double share) {
  if (values.empty() || !(share >= 0 && share <= 1))
    throw std::invalid_argument(
        fmt::format("a quantile takes values, and a share from 0 to 1 (got {} values, {})", values.size(), share));
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], place - std::floor(place));
}

double median_ratio(std::span<const double> a, std::span<const double> b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) ratios.push_back(a[i] / b[i]);
  return ratios.empty() ? std::numeric_limits<double>::quiet_NaN() : median(std::move(ratios));
}

Estimate batch_means(std::span<const double> batches) {
  if (batches.size() < 2)
    throw std::invalid_argument(fmt::format("a standard error takes at least 2 batches (got {})", batches.size()));
  const auto count = static_cast<double>(batches.size());
  double sum = 0;
  for (const double batch : batches) sum += batch;
  const double mean = sum / count;
  double squares = 0;
  for (const double batch : batches) squares += (batch - mean) * (batch - mean);
  return {mean, std::sqrt(squares / (count - 1) / count)};
}

Estimate batch_ratio(std::span<const double> numerators, std::span<const double> denominators) {
  const double denominator = batch_means(denominators).mean;
  const double ratio = batch_means(numerators).mean / denominator;
  std::vector<double> linearised;
  for (std::size_t i = 0; i < numerators.size(); ++i)
    linearised.push_back(ratio + (numerators[i] - ratio * denominators[i]) / denominator);
  return batch_means(linearised);
}

double interval_width(double budget, int comparisons, int batches) {
  if (!(budget > 0 && budget < 1 && comparisons >= 1 && batches >= 2))
    throw std::invalid_argument("a false-verdict budget in (0, 1), a comparison and two batches are needed");
  const boost::math::students_t student(batches - 1);
  return boost::math::quantile(boost::math::complement(student, budget / comparisons / 2));
}

double error_of_test(double confidence, int test) { return (1 - confidence) * 2 * std::pow(3.0, -test); }

Verdict judge(double predicted, const Estimate& observed, double tolerance, double width) {
  const double deviation = std::abs(observed.mean - predicted);
  const double reach = width * observed.standard_error;
  const double allowed = tolerance * std::abs(predicted);
  if (!std::isfinite(reach)) return Verdict::undecided;
  if (deviation + reach <= allowed) return Verdict::agrees;
  return deviation - reach > allowed ? Verdict::refuted : Verdict::undecided;
}

double detectable_deviation(double predicted, const Estimate& observed, double tolerance, double width) {
  return tolerance + (width + 2) * observed.standard_error / std::abs(predicted);
}

}  // namespace detp::validate
