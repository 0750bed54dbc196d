#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <string_view>
#include <variant>

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

/// Shines equally in all directions of a cone.
struct SpotLight {
  glm::dvec3 position{0.0};
  glm::dvec3 direction{0.0, -1.0, 0.0};  ///< of the cone's axis; any length > 0
  double half_angle = 0.5;               ///< between axis and border, radians, in (0, π]
};

/// Parallel light, as from the sun: a beam as wide as the sphere around the scene's box.
struct DirectionalLight {
  glm::dvec3 direction{0.0, -1.0, 0.0};  ///< in which the photons fly; any length > 0
};

/// The same radiance from all directions: uniform isotropic rays into the sphere around the scene's box.
struct EnvironmentLight {};

/// All triangles whose material emits. Each emits diffusely from its front, where its corners turn counter-clockwise.
struct SurfaceLight {};

struct Light {
  /// In the order of light_kinds.
  std::variant<PointLight, AreaLight, SpotLight, DirectionalLight, EnvironmentLight, SurfaceLight> shape;
  double flux = 1;  ///< power of all its photons, >= 0
};

/// What a light is, as users name it.
enum class LightKind { point, area, spot, directional, environment, surface };

inline constexpr std::array light_kinds{LightKind::point,       LightKind::area,        LightKind::spot,
                                        LightKind::directional, LightKind::environment, LightKind::surface};

/// "area", "point", …
[[nodiscard]] std::string_view name(LightKind kind);

[[nodiscard]] inline LightKind kind_of(const Light& light) { return light_kinds[light.shape.index()]; }

}  // namespace detp::sim
