#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/scene/scene.hpp"

namespace detp::sim {

/// Power that reaches the surfaces of one material.
struct SurfaceEnergy {
  std::string material;
  double arriving = 0;  ///< sum of the powers of photons, once for each time that one meets such a surface
  double absorbed = 0;
  double expected = 0;        ///< absorbed, as the material says: arriving, times the share that it absorbs
  double standard_error = 0;  ///< of `absorbed`, about `expected`
};

/// Where the power of the lights goes. Fluxes are estimated from the same photons that photon_paths traces.
struct EnergyBalance {
  std::uint64_t photons = 0;
  double flux = 0;            ///< of all lights
  double emitted = 0;         ///< by the photons; differs from the flux only by how they are spread over the lights
  double escaped = 0;         ///< left the scene
  double cut_off = 0;         ///< of photons that were still on their way after 1000 pieces
  double standard_error = 0;  ///< of `escaped`
  std::vector<SurfaceEnergy> surfaces = {};  ///< one for each material of the mesh; without materials, one

  [[nodiscard]] double absorbed() const;
};

/// Follows so many photons. The result depends on the seed alone, not on the number of threads. Throws as photon_paths.
[[nodiscard]] EnergyBalance energy_balance(const Scene& scene, std::uint64_t photons, std::uint64_t seed,
                                           const std::stop_token& stop = {});

}  // namespace detp::sim
