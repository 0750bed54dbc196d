#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "detp/model/vocabulary/vocabulary.hpp"

/// Random workloads for tests, the same on every machine.
namespace detp::support {

/// Random numbers from an engine that yields 64-bit words.
template <class Engine>
class NumbersFrom {
 public:
  explicit NumbersFrom(const Engine& engine) : engine_(engine) {}

  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * std::ldexp(double(engine_() >> 11), -53); }

  /// Log-uniform in [low, high).
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }

  /// A whole number, log-uniform from low to high.
  double count(double low, double high) { return std::floor(log_uniform(low, high)); }

  /// A whole number, uniform from low to high.
  std::int64_t whole(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }

 private:
  Engine engine_;
};

class RandomNumbers : public NumbersFrom<std::mt19937_64> {
 public:
  explicit RandomNumbers(std::uint64_t seed) : NumbersFrom(std::mt19937_64(seed)) {}
};

/// A workload and a ratio: Q 0.05 … 0.99, d/r₀ 1e-6 … 0.9, n_R and n_P 1 … 1e9.
struct RatioAndWorkload {
  Workload workload;
  double ratio;
};

inline RatioAndWorkload random_workload(RandomNumbers& random) {
  const double outer = random.log_uniform(1e-3, 1e3);
  return {.workload = {.rays = random.count(1, 1e9),
                       .samples = random.count(1, 1e9),
                       .disc_radius = outer * random.log_uniform(1e-6, 0.9),
                       .sphere_radius = outer,
                       .box = {outer, outer, outer}},
          .ratio = random.uniform(0.05, 0.99)};
}

}  // namespace detp::support
