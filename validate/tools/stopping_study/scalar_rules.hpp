#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "stream.hpp"

/// Rules that end the estimate of one mean when its relative error is small enough.
namespace detp::tools {

struct ScalarTarget {
  double error = 0.1;  ///< relative
  double confidence = 0.95;
  double first = 1000;  ///< values before a rule can know anything
  double look = 200;    ///< values between two looks
};

struct ScalarEnd {
  double values = 0;
  double estimate = 0;
};

struct ScalarRule {
  const char* name;
  const char* source;
  /// Nothing if the rule is not for such a stream.
  std::optional<ScalarEnd> (*run)(Stream& stream, const ScalarTarget& target);
};

[[nodiscard]] std::span<const ScalarRule> scalar_rules();

/// Number of values at which the normal distribution has the error with the confidence, if the variance were known.
[[nodiscard]] double best_fixed_size(const Distribution& distribution, const ScalarTarget& target);

/// Least number of hits k at which (k - 1)/G, G of a gamma distribution with shape k, is within 1 ± error with the confidence (huber2017).
[[nodiscard]] std::uint64_t gamma_bernoulli_hits(double error, double confidence);

}  // namespace detp::tools
