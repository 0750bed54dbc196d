#pragma once

#include <cstdint>
#include <optional>

/// Estimates a sum over a random stream of rays from its first rays.
namespace detp::sim {

/// What batches of rays (or of photons) bring, accumulated for a standard error.
struct Batches {
  std::uint64_t count = 0;  ///< number of batches
  std::uint64_t rays = 0;
  double sum = 0;      ///< Σ x
  double squares = 0;  ///< Σ x²/m over the batches, with x of m rays

  /// Adds a batch of at least one ray.
  void add(std::uint64_t batch_rays, double of_batch);

  Batches& operator+=(const Batches& other);
};

/// The estimated sum over all rays.
struct SumEstimate {
  double value = 0;
  std::optional<double> standard_error;  ///< unknown for fewer than two batches
};

/// Estimates the sum over N = `all_rays` independent rays as X N/n, if `batches` has the sum X of n of these rays. The
/// standard error SE follows from the differences between the batches.
///
///     SE² = N (N - n)/n σ²,   σ² = Σ m (x/m - X/n)² / (B - 1)        B batches of m rays that bring x
///
/// σ² is the variance of what one ray brings. For n ≪ N the squared error is σ² N²/n; the factor 1 - n/N accounts for
/// what is already known. `batches` must have at least one ray.
[[nodiscard]] SumEstimate estimate_sum(const Batches& batches, std::uint64_t all_rays);

}  // namespace detp::sim
