#pragma once

#include <vector>

#include "emitter.hpp"

namespace detp::sim {

/// A photon at its start, with its power.
struct EmittedPhoton {
  PhotonStart start;
  double power = 1;  ///< divided by the number of photons emitted: the photon's share of the flux of all lights
};

/// The lights of a scene. Photon number i comes from light L with the probability p = 0.9 Φ_L / Φ + 0.1 / n, where Φ_L is
/// the light's flux, Φ that of all n lights; lights without flux have p = 0. It carries the power Φ_L / p. So photons go
/// by power, and still a dim lamp among many gets a tenth of an even share, with weaker photons. Numbers are spread
/// over the lights by van der Corput's sequence: the share of each of 2^k consecutive photons that comes from a light
/// is off by about 2^-k.
class Lights {
 public:
  /// Throws std::invalid_argument if there is no light, a flux is negative, subnormal or not finite, or all are zero; and as
  /// emitter_of.
  explicit Lights(const Scene& scene);

  /// Photon number `photon`, determined by four uniform numbers in [0, 1).
  [[nodiscard]] EmittedPhoton photon(std::uint64_t photon, const std::array<double, 4>& random) const;

  [[nodiscard]] double power(std::uint64_t photon) const { return share_of(photon).power; }
  /// Of the photon's light: it is that of triangles whose material emits.
  [[nodiscard]] bool is_surface(std::uint64_t photon) const { return share_of(photon).is_surface; }
  /// Of the photon's light: it has an area, or shines from many directions.
  [[nodiscard]] bool has_extent(std::uint64_t photon) const { return share_of(photon).has_extent; }

 private:
  struct Share {
    Emitter emitter;
    double up_to;  ///< sum of the probabilities up to and including this light
    double power;
    bool has_extent;
    bool is_surface;
  };
  [[nodiscard]] const Share& share_of(std::uint64_t photon) const;

  std::vector<Share> shares_;
};

}  // namespace detp::sim
