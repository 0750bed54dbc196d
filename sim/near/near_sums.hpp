#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "detp/sim/search/outcome.hpp"
#include "detp/sim/search/problem.hpp"

/// Sums over the photons that landed near each sample, for the estimators that look at landings.
namespace detp::sim {

/// A photon's landing that counts for a disc.
struct Landed {
  std::uint32_t ray;
  double weight;  ///< its power counts so many times; 1 unless a sample averages over triangles
};

/// What counts for one disc: the landings, and the area over which their power is spread.
struct Near {
  std::vector<Landed> landed = {};
  double area = 0;  ///< 0: none, then the irradiance is 0

  void clear() {
    landed.clear();
    area = 0;
  }
};

/// Predicted bytes of the sums and of the results.
[[nodiscard]] double near_bytes(const Problem& problem, const RunOptions& options);

/// Calls find(disc, near) for each disc, on options.threads threads, and sums:
///
///     E = Σ w Φ / A        SE, bound: error_of_power, where x is what all landings of one photon bring
///
/// Fills in the outcome's hits, irradiance, and standard errors and bounds if they are requested; after a stop request those of
/// the discs that were done. Landings are added in the order of their rays.
void sum_near(const Problem& problem, const RunOptions& options,
              const std::function<void(std::uint32_t disc, Near& near)>& find, Outcome& outcome);

}  // namespace detp::sim
