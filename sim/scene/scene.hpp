#pragma once

#include <optional>
#include <string>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"
#include "light.hpp"
#include "mesh.hpp"
#include "up.hpp"

namespace detp::sim {

/// The default rays of a scene.
enum class Field {
  isotropic,  ///< uniform isotropic lines through S₀
  photons,    ///< photon paths from the lights
  mixed       ///< a mixture of isotropic lines, parallel lines and segments from a point (mixed_field.hpp)
};

/// A scene: the samples at which irradiance is wanted, the surfaces and the lights.
struct Scene {
  std::string name;             ///< "@tree", or the file's path
  Mesh mesh;                    ///< no triangles in @uniform
  std::vector<Sample> samples;  ///< at the mesh's vertices, or @uniform's points
  Box box;                      ///< of the samples and of the mesh's used vertices; in @uniform its cube
  std::vector<Light> lights;    ///< none in @uniform
  Field field = Field::photons;
  bool lights_placed = false;  ///< not the scene's own
  Up up;                       ///< by which they were placed
  /// How far pieces of photon paths go on through the surface where they end, at most up to the next surface, so that no
  /// surface shadows its own discs (photon_paths.hpp). Unbounded: always up to the second intersection.
  double overshoot = 0;
  /// Irradiance at all surfaces, where it is known.
  std::optional<double> known_irradiance = {};
  bool rgb =
      false;  ///< materials have their largest shares (Materials::take_largest); photons carry red, green and blue
  Notices notices;
};

}  // namespace detp::sim
