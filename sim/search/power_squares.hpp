#pragma once

#include <vector>

#include "outcome.hpp"
#include "problem.hpp"

namespace detp::sim {

/// Bytes for each disc: its sum of squares and its standard error.
constexpr double error_bytes = 2 * sizeof(double);

/// For each disc, the sum of the squared powers of its hits, which gives the standard error of the irradiance.
///
/// As long as all rays carry the same power, the sums follow from the numbers of hits. After that, the sums need pairs.
class PowerSquares {
 public:
  /// Returns whether the search must find pairs. To be called before the problem's rays are searched. `before` are the
  /// totals of all earlier rays (empty: none).
  [[nodiscard]] bool needs_pairs(const Problem& problem, const Totals& before);

  /// Adds the pairs that the search found. Does nothing if needs_pairs was false.
  void add(const Problem& problem, const std::vector<Pair>& pairs);

  /// Fills in outcome.standard_error from the outcome's hits and irradiance and the number N = `rays` of rays searched.
  ///
  ///     SE² = N/(N - 1) (Σ x² - (Σ x)²/N),   x = p/(π d²) for a ray of power p that hits the disc of radius d, else 0
  ///
  /// SE² estimates the variance of the sum over N independent rays. The error is 0 if no ray hits the disc, infinite if
  /// N = 1. Rays of one photon path are dependent: if several of them hit the same disc, the true error is larger.
  void finish(std::span<const Disc> discs, std::uint64_t rays, Outcome& outcome) const;

 private:
  bool by_pairs_ = false;
  double power_ = 0;             ///< power of each ray so far, unless by_pairs_; 0: no ray
  std::vector<double> squares_;  ///< sum of squares of each disc, if by_pairs_
};

}  // namespace detp::sim
