#pragma once

#include <cstdint>
#include <vector>

#include "detp/sim/scene/scene.hpp"
#include "emitter.hpp"
#include "ray_caster.hpp"

namespace detp::sim {

/// The straight pieces of some photons' paths, in order, each with the number of its photon.
struct PhotonPieces {
  std::vector<Ray> rays;
  std::vector<std::uint64_t> photons;
};

/// Follows photons through a scene as photon_paths (photon_paths.hpp) tells; each is a function of the seed and its
/// number alone. May be used by several threads at once.
class PhotonTracer {
 public:
  /// Throws std::invalid_argument for a scene that photon paths cannot be traced in; Stopped if a stop was requested.
  PhotonTracer(const Scene& scene, std::uint64_t seed, const std::stop_token& stop = {});

  /// Pieces of photons first … last - 1, each of power 1. Throws Stopped if a stop was requested.
  [[nodiscard]] PhotonPieces trace(std::uint64_t first, std::uint64_t last, const std::stop_token& stop = {}) const;

 private:
  void add_path(std::uint64_t photon, std::vector<Ray>& rays) const;
  void add_last_piece(const Departure& from, std::vector<Ray>& rays) const;
  [[nodiscard]] Ray piece(const Departure& from, double distance, double beyond) const;

  RayCaster caster_;
  Emitter emitter_;
  double albedo_;
  std::uint64_t seed_;
  double reach_ = 0;  ///< radius of the sphere around the box where photons leave, own units
  double gap_ = 0;    ///< own units
};

}  // namespace detp::sim
