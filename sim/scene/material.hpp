#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace detp::sim {

/// What a material does with red, green and blue: its shares and radiance in each of these bands.
struct Colours {
  glm::dvec3 diffuse{0.0}, specular{0.0}, glass{0.0}, emitted{0.0};
};

/// How a surface scatters light, in one channel. The shares are probabilities: the rest of 1 is absorbed.
struct Material {
  std::string name = {};
  double diffuse = 0.5;  ///< share reflected diffusely (cosine-distributed), on either side
  double specular = 0;   ///< share reflected around the mirror direction
  /// Exponent of the lobe around the mirror direction, as in Phong's model, at least 1. Infinite: a mirror.
  double shininess = std::numeric_limits<double>::infinity();
  double glass = 0;                     ///< share that is reflected or refracted by Fresnel's equations
  double index = 1.5;                   ///< of refraction behind the front, over that before it; > 0
  double emitted = 0;                   ///< radiance of the front, >= 0 and not subnormal
  std::optional<Colours> colours = {};  ///< none: grey
};

/// Of a material without colours: its shares in all bands.
[[nodiscard]] Colours colours_of(const Material& material);

/// The material of triangles that have none.
inline const Material matt{};

/// Throws std::invalid_argument, naming the material, unless all numbers are finite (except the shininess) and in range,
/// and the shares add up to at most 1.
void check(const Material& material);

/// In place of the material of a back: the back is as the front, and emits nothing.
inline constexpr std::uint16_t no_back = UINT16_MAX;

/// The materials of a mesh's triangles.
struct Materials {
  std::vector<Material> all = {};               ///< none: every triangle is matt
  std::vector<std::uint16_t> of_triangle = {};  ///< indices into `all`; none: every triangle has the first material
  /// Of the backs: indices into `all`, or no_back; none: no_back for all. A back with a material of its own is the front of
  /// a triangle that faces the other way.
  std::vector<std::uint16_t> of_back = {};

  /// Index into `all`, which has some.
  [[nodiscard]] std::uint16_t number_of(std::size_t triangle) const {
    return of_triangle.empty() ? std::uint16_t{0} : of_triangle[triangle];
  }
  [[nodiscard]] const Material& of(std::size_t triangle) const {
    if (all.empty()) return matt;
    return of_triangle.empty() ? all.front() : all[of_triangle[triangle]];
  }
  /// Whether the triangle's back has a material of its own.
  [[nodiscard]] bool has_back(std::size_t triangle) const { return !of_back.empty() && of_back[triangle] != no_back; }
  /// Of the triangle's front or back.
  [[nodiscard]] const Material& of(std::size_t triangle, bool front) const {
    return !front && has_back(triangle) ? all[of_back[triangle]] : of(triangle);
  }
  /// With the largest share and radiance of the three bands each. Where these add up to more than 1, all are lowered.
  void take_largest();
  /// With the shares and radiance of one band.
  void take_band(int band);
  /// Radiance of the triangle's front or back.
  [[nodiscard]] double emitted(std::size_t triangle, bool front) const {
    if (front) return of(triangle).emitted;
    return has_back(triangle) ? all[of_back[triangle]].emitted : 0;
  }
};

/// Throws std::invalid_argument as check(Material), and unless each of so many triangles has a material, and so has its
/// back if backs have any.
void check(const Materials& materials, std::size_t triangles);

}  // namespace detp::sim
