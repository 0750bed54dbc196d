#pragma once

#include <array>

#include "detp/sim/scene/scene.hpp"

namespace detp::sim {

/// Where a photon starts, and which way.
struct Departure {
  glm::dvec3 origin{0.0};
  glm::dvec3 direction{0.0, 0.0, 1.0};  ///< unit length
};

/// Draws photons from a light, each with the same power.
class Emitter {
 public:
  /// Throws std::invalid_argument for a light that is not finite, or an area light without area.
  explicit Emitter(const Light& light);

  /// The photon of four uniform numbers in [0, 1).
  [[nodiscard]] Departure photon(const std::array<double, 4>& random) const;

 private:
  Light light_;
  glm::dvec3 normal_{0.0};  ///< of an area light
};

}  // namespace detp::sim
