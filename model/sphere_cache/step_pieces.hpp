#pragma once

#include <cmath>
#include <stdexcept>

#include "sphere_count.hpp"

/// The intervals of Q between the steps of k. The steps are at Q_j = (d/r₀)^{1/j}, where r_j = d. With the k of
/// eq (6), T_I has its minima, all equal, at these Q_j (the paper's text on its fig 12 calls them peaks). With the k of
/// eq (7), which rounds up, T_I has its maxima there.
namespace detp::model {

/// The range of Q that is searched.
inline constexpr double least_ratio = 0.02;
inline constexpr double most_ratio = 0.98;

/// Ends of the intervals, slightly off the steps: ln Q is 1 ± 4e-12 times its value at the step. At these ends, plain
/// arithmetic gives the right k (see sphere_count), and T is within 1e-10 of its value at the step.
class StepPieces {
 public:
  /// Throws std::invalid_argument for a workload out of range or d >= r₀: then there is no sphere.
  explicit StepPieces(const Valid<Workload>& workload) {
    if (workload.disc_radius >= workload.sphere_radius)
      throw std::invalid_argument("the disc radius must be smaller than the sphere radius, or no sphere pays");
    log_radii_ = std::log(static_cast<long double>(workload.disc_radius) / workload.sphere_radius);
  }

  /// Just above Q_j, so that r_j > d; 0 for j = 0.
  [[nodiscard]] double above(std::int64_t j) const { return j == 0 ? 0 : ratio(j, 1 - margin); }

  /// Just below Q_j, so that r_j < d.
  [[nodiscard]] double below(std::int64_t j) const { return ratio(j, 1 + margin); }

 private:
  static constexpr long double margin = 4e-12L;

  [[nodiscard]] double ratio(std::int64_t j, long double factor) const {
    return static_cast<double>(std::exp(factor * log_radii_ / static_cast<long double>(j)));
  }

  long double log_radii_ = 0;
};

}  // namespace detp::model
