#pragma once

#include <cstdint>
#include <optional>

/// Estimates the number of hits of a random stream of rays from the hits of its first rays.
namespace detp::sim {

/// Hits of batches of rays, accumulated for a standard error.
struct HitBatches {
  std::uint64_t count = 0;  ///< number of batches
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;
  double squares = 0;  ///< Σ h²/m over the batches, with h hits of m rays

  /// Adds a batch of at least one ray.
  void add(std::uint64_t batch_rays, std::uint64_t batch_hits);

  HitBatches& operator+=(const HitBatches& other);
};

/// The estimated hits of all rays.
struct HitEstimate {
  double hits = 0;
  std::optional<double> standard_error;  ///< unknown for fewer than two batches
};

/// Estimates the hits of N = `all_rays` independent rays as H N/n, if `batches` has H hits of n of these rays. The
/// standard error SE follows from the differences between the batches.
///
///     SE² = N (N - n)/n σ²,   σ² = Σ m (h/m - H/n)² / (B - 1)        B batches of m rays with h hits
///
/// σ² is the variance of one ray's hits. For n ≪ N the squared error is σ² N²/n; the factor 1 - n/N accounts for the
/// hits that are already known. `batches` must have at least one ray.
[[nodiscard]] HitEstimate estimate_hits(const HitBatches& batches, std::uint64_t all_rays);

}  // namespace detp::sim
