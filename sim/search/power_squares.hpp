#pragma once

#include <vector>

#include "outcome.hpp"
#include "problem.hpp"

namespace detp::sim {

/// Bytes for each disc: its sum of squares and its standard error.
constexpr double error_bytes = 2 * sizeof(double);

/// The squares of the powers of each disc's hits, summed up: what the standard error of its irradiance needs.
///
/// As long as all rays carry one power, they follow from the hits. From then on pairs are needed.
class PowerSquares {
 public:
  /// To be called before the problem's rays are searched; `before` are the hits of the rays before them (empty: none).
  /// Whether the search must find pairs.
  [[nodiscard]] bool needs_pairs(const Problem& problem, const Totals& before);

  /// Adds the pairs that it found, if they were needed.
  void add(const Problem& problem, const std::vector<Pair>& pairs);

  /// Fills in outcome.standard_error from its hits and irradiance and the number of rays searched.
  ///
  ///     SE² = N/(N - 1) (Σ x² - (Σ x)²/N),   x = p/(π d²) for a ray of power p that hits the disc, else 0
  ///
  /// The variance of the sum of N independent rays, estimated from them. 0 where none hit the disc, infinite for a
  /// single ray. Rays of one photon path depend on each other, as far as several of them hit the same disc: then the
  /// error is larger.
  void finish(std::span<const Disc> discs, std::uint64_t rays, Outcome& outcome) const;

 private:
  bool by_pairs_ = false;
  double power_ = 0;             ///< of all rays so far, unless by pairs; 0: no ray
  std::vector<double> squares_;  ///< of each disc, if by pairs
};

}  // namespace detp::sim
