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

/// A parallelogram that shines from one face, diffusely (cosine-distributed).
struct AreaLight {
  glm::dvec3 corner{0.0};
  glm::dvec3 edge_u{1.0, 0.0, 0.0};
  glm::dvec3 edge_v{0.0, 1.0, 0.0};  ///< it shines towards edge_u × edge_v
};

using Light = std::variant<PointLight, AreaLight>;

/// What the rays of a scene are by default.
enum class Field {
  isotropic,  ///< uniform isotropic lines through S₀
  photons     ///< photon paths from the light
};

/// A scene: where irradiance is wanted, and what light meets.
struct Scene {
  std::string name;             ///< "@tree", or the file's path
  Mesh mesh;                    ///< no triangles in @uniform
  std::vector<Sample> samples;  ///< at the mesh's vertices, or @uniform's points
  Box box;                      ///< of the samples and the mesh's used vertices; of @uniform, its cube
  std::optional<Light> light;   ///< none in @uniform
  double albedo = 0.5;          ///< share of a photon's meetings with a surface after which it goes on, diffusely
  Field field = Field::photons;
  Notices notices;
};

}  // namespace detp::sim
