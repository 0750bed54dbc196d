#pragma once

#include <array>

#include "detp/sim/scene/scene.hpp"

namespace detp::sim {

/// Origin and direction of a photon.
struct PhotonStart {
  glm::dvec3 origin{0.0};
  glm::dvec3 direction{0.0, 0.0, 1.0};  ///< unit length
};

/// Samples photons from a light. All photons have the same power.
class Emitter {
 public:
  /// Throws std::invalid_argument for a light that is not finite, or an area light without area.
  explicit Emitter(const Light& light);

  /// The photon that four uniform numbers in [0, 1) determine.
  [[nodiscard]] PhotonStart photon(const std::array<double, 4>& random) const;

 private:
  Light light_;
  glm::dvec3 normal_{0.0};  ///< of an area light
};

}  // namespace detp::sim
