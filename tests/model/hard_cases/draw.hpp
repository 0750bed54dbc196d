#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/geometry/random.hpp"
#include "support/random_workload.hpp"

/// Random inputs from the whole domain of the formulas. An input depends only on its family and index, not on threads.
namespace detp::hard_cases {

/// The 64-bit words of one index.
class Words {
 public:
  Words(std::uint64_t family, std::uint64_t index) : family_(family), index_(index) {}

  std::uint64_t operator()() {
    if (next_ % 4 == 0) words_ = sim::bits4(family_, sim::Stream::tests, index_, next_ / 4);
    return words_[next_++ % 4];
  }

 private:
  std::uint64_t family_;
  std::uint64_t index_;
  std::uint64_t next_ = 0;
  std::array<std::uint64_t, 4> words_{};
};

class Draw : public support::NumbersFrom<Words> {
 public:
  Draw(std::uint64_t family, std::uint64_t index) : NumbersFrom(Words(family, index)) {}

  /// Q in (0, 1), one third each: 1 - Q log-uniform down to 2⁻⁵³; Q log-uniform down to 2⁻¹⁰⁷⁴; Q uniform.
  double ratio() {
    const std::int64_t kind = whole(0, 2);
    const double q = kind == 0 ? 1 - log_uniform(0x1p-54, 1) : kind == 1 ? log_uniform(5e-324, 1) : uniform(0, 1);
    return std::clamp(q, std::numeric_limits<double>::denorm_min(), 1 - 0x1p-53);
  }

  /// n_R or n_P.
  double rays_or_samples() { return std::max(1.0, count(1, 1e18)); }

  /// An index of a sphere, 1 … 9e18: log-uniform, or such that Qⁱ is spread over the range of doubles.
  std::int64_t index(double ratio) {
    const double most = 9e18;
    const double i = whole(0, 1) == 0 ? log_uniform(1, most) : uniform(0, 745) / -std::log(ratio);
    return static_cast<std::int64_t>(std::clamp(std::ceil(i), 1.0, most));
  }

  /// A time or another factor: mostly within 1e±12, otherwise anywhere in the range of doubles.
  double factor() { return whole(0, 3) > 0 ? log_uniform(1e-12, 1e12) : anywhere(); }

  /// A positive normal double, log-uniform.
  double anywhere() { return log_uniform(1e-307, 1e308); }

  /// n_R rays, n_P samples, d/r₀ from 1e-300 to 1 and occasionally above, r₀ within 1e±90.
  Workload workload() {
    const double outer = log_uniform(1e-90, 1e90);
    const double longest = std::clamp(outer * uniform(0.5, 1.2), 1e-90, 1e90);
    return {
        .rays = rays_or_samples(),
        .samples = rays_or_samples(),
        .disc_radius = outer * (whole(0, 9) == 0 ? log_uniform(1, 10) : log_uniform(1e-300 / std::min(1.0, outer), 1)),
        .sphere_radius = outer,
        .box = {longest, longest * uniform(0, 1), longest * log_uniform(1e-12, 1)}};
  }
};

}  // namespace detp::hard_cases
