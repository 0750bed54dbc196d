#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"
#include "mesh.hpp"

namespace detp::sim {

/// Shines equally in all directions from a point.
struct PointLight {
  glm::dvec3 position{0.0};
};

/// A parallelogram that emits from one face, diffusely (cosine-distributed).
struct AreaLight {
  glm::dvec3 corner{0.0};
  glm::dvec3 edge_u{1.0, 0.0, 0.0};
  glm::dvec3 edge_v{0.0, 1.0, 0.0};  ///< it emits towards edge_u × edge_v
};

using Light = std::variant<PointLight, AreaLight>;

/// The default rays of a scene.
enum class Field {
  isotropic,  ///< uniform isotropic lines through S₀
  photons     ///< photon paths from the light
};

/// A scene: the samples at which irradiance is wanted, the surfaces and the light.
struct Scene {
  std::string name;             ///< "@tree", or the file's path
  Mesh mesh;                    ///< no triangles in @uniform
  std::vector<Sample> samples;  ///< at the mesh's vertices, or @uniform's points
  Box box;                      ///< of the samples and of the mesh's used vertices; in @uniform its cube
  std::optional<Light> light;   ///< none in @uniform
  double albedo = 0.5;          ///< probability that a photon that meets a surface is reflected, diffusely
  Field field = Field::photons;
  Notices notices;
};

}  // namespace detp::sim
