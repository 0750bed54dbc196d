#pragma once

#include <cstdint>
#include <vector>

#include "detp/sim/scene/scene.hpp"
#include "emitter.hpp"
#include "ray_caster.hpp"

namespace detp::sim {

/// The straight pieces of some photons' paths, in order, and for each piece the number of its photon.
struct PhotonPieces {
  std::vector<Ray> rays;
  std::vector<std::uint64_t> photons;
};

/// Traces photons through a scene as photon_paths (photon_paths.hpp) describes. Each photon is a function of the seed
/// and its number alone. Several threads may use one tracer.
class PhotonTracer {
 public:
  /// Throws std::invalid_argument for a scene in which photon paths cannot be traced, std::runtime_error if Embree
  /// fails, and Stopped if a stop was requested.
  PhotonTracer(const Scene& scene, std::uint64_t seed, const std::stop_token& stop = {});

  /// Pieces of photons first … last - 1, each of power 1. Throws Stopped if a stop was requested.
  [[nodiscard]] PhotonPieces trace(std::uint64_t first, std::uint64_t last, const std::stop_token& stop = {}) const;

 private:
  void add_path(std::uint64_t photon, std::vector<Ray>& rays) const;
  void add_last_piece(const PhotonStart& from, std::vector<Ray>& rays) const;
  [[nodiscard]] Ray piece(const PhotonStart& from, double distance, double beyond) const;

  RayCaster caster_;
  Emitter emitter_;
  double albedo_;
  std::uint64_t seed_;
  double reach_ = 0;  ///< radius of the sphere around the box at which photons leave, in the caster's own units
  double gap_ = 0;    ///< in the caster's own units
};

}  // namespace detp::sim
