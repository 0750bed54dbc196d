#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "detp/sim/geometry/paths.hpp"
#include "detp/sim/scene/scene.hpp"
#include "photon_walk.hpp"

namespace detp::sim {

/// The straight pieces of some photons' paths, in order.
struct PhotonPieces : Paths {
  std::vector<PathEnd> ends = {};                     ///< of each photon
  std::vector<std::array<BandLedger, 3>> bands = {};  ///< of each photon with three powers
};

/// Traces photons through a scene as photon_paths (photon_paths.hpp) describes. Each photon is a function of the seed
/// and its number alone. Several threads may use one tracer.
class PhotonTracer {
 public:
  /// Throws std::invalid_argument for a scene in which photon paths cannot be traced, and Stopped if a stop was requested.
  PhotonTracer(const Scene& scene, std::uint64_t seed, const std::stop_token& stop = {});
  PhotonTracer(const Scene& scene, std::uint64_t seed, std::shared_ptr<const RayCaster> caster);

  /// Pieces of photons first … last - 1, each with its photon's power (EmittedPhoton); of fewer photons if these have `most` pieces.
  /// Throws std::length_error if they would not fit in memory, and Stopped if a stop was requested.
  [[nodiscard]] PhotonPieces trace(std::uint64_t first, std::uint64_t last, const std::stop_token& stop = {},
                                   std::uint64_t most = UINT64_MAX) const;

  /// Number of powers of each ray.
  [[nodiscard]] std::size_t bands() const { return walk_.rgb() ? 3 : 1; }
  /// Power of a photon.
  [[nodiscard]] double power(std::uint64_t photon) const { return walk_.power(photon); }

 private:
  PhotonWalk walk_;
};

}  // namespace detp::sim
