#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "detp/sim/photons/photon_walk.hpp"
#include "detp/sim/scene/scene.hpp"

namespace detp::support {

/// Power that reaches the surfaces of one material: sums over photons.
struct SurfaceEnergy {
  double arriving = 0;  ///< once for each time that a photon meets such a surface
  double absorbed = 0;
  double expected = 0;  ///< absorbed, as the material says: arriving, times the share that it absorbs
  double variance = 0;  ///< of `absorbed`, about `expected`
};

/// Where the power of the lights goes: sums over the photons 0 … photons - 1, the same that photon_paths traces.
class EnergyBalance {
 public:
  EnergyBalance(const sim::Scene& scene, std::uint64_t photons, std::uint64_t seed)
      : surfaces(scene.mesh.materials.all.size()), materials_(scene.mesh.materials) {
    const sim::PhotonWalk walk(scene, seed);
    for (std::uint64_t photon = 0; photon < photons; ++photon) {
      const double power = walk.power(photon);
      emitted += power;
      const sim::PathEnd end = walk.follow(photon, *this);
      if (end == sim::PathEnd::left || end == sim::PathEnd::missed) left += power;
      if (end == sim::PathEnd::cut) stopped += power;
    }
  }

  double emitted = 0;
  double left = 0;                      ///< by photons that left the scene
  double stopped = 0;                   ///< by photons that were still on their way after the most pieces
  std::vector<SurfaceEnergy> surfaces;  ///< one for each material

  [[nodiscard]] double absorbed() const {
    double sum = 0;
    for (const SurfaceEnergy& surface : surfaces) sum += surface.absorbed;
    return sum;
  }

  void piece(const sim::Ray&, double) {}

  void met(std::uint32_t triangle, double power, bool is_absorbed) {
    const auto& numbers = materials_.of_triangle;
    const sim::Material& material = materials_.of(triangle);
    const double share = std::clamp(1 - material.diffuse - material.specular - material.glass, 0.0, 1.0);
    SurfaceEnergy& surface = surfaces[numbers.empty() ? 0 : numbers[triangle]];
    surface.arriving += power;
    surface.absorbed += is_absorbed ? power : 0;
    surface.expected += share * power;
    surface.variance += share * (1 - share) * power * power;
  }

 private:
  const sim::Materials& materials_;
};

}  // namespace detp::support
