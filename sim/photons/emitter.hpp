#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "detp/sim/scene/scene.hpp"

namespace detp::sim {

/// Origin and direction of a photon.
struct PhotonStart {
  glm::dvec3 origin{0.0};
  glm::dvec3 direction{0.0, 0.0, 1.0};         ///< unit length
  std::optional<std::uint32_t> triangle = {};  ///< on which the origin lies
  bool on_back = false;                        ///< of the triangle
};

/// Samples the photons of one light, all of the same power: the photon that four uniform numbers in [0, 1) determine.
using Emitter = std::function<PhotonStart(const std::array<double, 4>& random)>;

/// The emitter of a light of the scene; it keeps copies of what it needs. Throws std::invalid_argument for a light that is not
/// finite, has no area or no direction, and for a surface light of a scene in which no triangle with an area emits.
[[nodiscard]] Emitter emitter_of(const Light& light, const Scene& scene);

/// A box with all points from which photons of the light start.
[[nodiscard]] Box starts_of(const Light& light, const Scene& scene);

/// Flux of the scene's emitting triangles: π times the sum of area times emitted radiance, of fronts and backs.
[[nodiscard]] double emitted_flux(const Mesh& mesh);

}  // namespace detp::sim
