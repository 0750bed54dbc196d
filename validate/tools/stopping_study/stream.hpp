#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace detp::tools {

/// How often each value of a distribution came.
using Counts = std::vector<double>;

/// A distribution of values that a photon may bring to a disc: a few values >= 0, each with its probability; the first is 0.
struct Distribution {
  std::string name;
  std::vector<double> values;
  std::vector<double> probabilities;

  [[nodiscard]] double mean() const { return moment(1); }
  /// Variance over the square of the mean.
  [[nodiscard]] double relative_variance() const { return moment(2) / (mean() * mean()) - 1; }
  [[nodiscard]] double moment(int order) const {
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += probabilities[i] * std::pow(values[i], order);
    return sum;
  }
};

/// Hits of one power.
[[nodiscard]] inline Distribution hits(std::string name, double probability) {
  return {std::move(name), {0, 1}, {1 - probability, probability}};
}

/// Hits whose power spreads over `levels` values from 0 to 1 by a log-normal distribution, cut off at 0.1 %.
[[nodiscard]] inline Distribution uneven_hits(std::string name, double probability, double spread) {
  constexpr int levels = 12;
  constexpr double reach = 3.1;  // standard deviations
  Distribution made{std::move(name), {0}, {1 - probability}};
  double sum = 0;
  for (int i = 0; i < levels; ++i) {
    const double normal = reach * (2 * (i + 0.5) / levels - 1);
    made.values.push_back(std::exp(spread * (normal - reach)));
    made.probabilities.push_back(std::exp(-0.5 * normal * normal));
    sum += made.probabilities.back();
  }
  for (std::size_t i = 1; i < made.values.size(); ++i) made.probabilities[i] *= probability / sum;
  return made;
}

/// Independent values of a distribution.
class Stream {
 public:
  Stream(const Distribution& distribution, std::uint64_t seed) : distribution_(distribution), random_(seed) {}

  /// Of so many further values.
  Counts next(std::uint64_t count) {
    Counts counts(distribution_.values.size());
    double left = 1;
    for (std::size_t i = counts.size(); i-- > 1;) {
      std::binomial_distribution<std::uint64_t> binomial(count, std::min(1.0, distribution_.probabilities[i] / left));
      const std::uint64_t found = binomial(random_);
      counts[i] = static_cast<double>(found);
      count -= found;
      left -= distribution_.probabilities[i];
    }
    counts[0] = static_cast<double>(count);
    return counts;
  }

  /// The number of values up to the hit with this number.
  double values_to_hit(std::uint64_t hit) {
    std::negative_binomial_distribution<std::uint64_t> misses(hit, 1 - distribution_.probabilities[0]);
    return static_cast<double>(hit + misses(random_));
  }

  [[nodiscard]] const Distribution& distribution() const { return distribution_; }
  [[nodiscard]] std::mt19937_64& random() { return random_; }

 private:
  const Distribution& distribution_;
  std::mt19937_64 random_;
};

}  // namespace detp::tools
