#pragma once

#include <cstdint>
#include <optional>

/// From the hits of the first rays of a random stream to those of all.
namespace detp::sim {

/// Hits of batches of rays, summed up as far as a standard error needs them.
struct HitBatches {
  std::uint64_t count = 0;
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;
  double squares = 0;  ///< Σ h²/m over the batches, h hits of m rays

  /// Adds a batch of at least one ray.
  void add(std::uint64_t batch_rays, std::uint64_t batch_hits);

  HitBatches& operator+=(const HitBatches& other);
};

/// The hits of all rays, estimated.
struct HitEstimate {
  double hits = 0;
  std::optional<double> standard_error;  ///< unknown from fewer than two batches
};

/// The hits of N = `all_rays` independent rays, from batches of n of them: H N/n, where H is their number of hits.
///
///     SE² = N (N - n)/n σ²,   σ² = Σ m (h/m - H/n)² / (B - 1)        B batches of m rays with h hits
///
/// σ² is the variance of a ray's hits; σ² N²/n would be the square of the error if n ≪ N, and the factor 1 - n/N takes
/// account of what is known already. `batches` must hold a ray.
[[nodiscard]] HitEstimate estimate_hits(const HitBatches& batches, std::uint64_t all_rays);

}  // namespace detp::sim
