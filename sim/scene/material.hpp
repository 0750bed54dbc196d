#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace detp::sim {

/// How a surface scatters light, in one channel. The shares are probabilities: the rest of 1 is absorbed.
struct Material {
  std::string name = {};
  double diffuse = 0.5;  ///< share reflected diffusely (cosine-distributed), on either side
  double specular = 0;   ///< share reflected around the mirror direction
  /// Exponent of the lobe around the mirror direction, as in Phong's model, at least 1. Infinite: a mirror.
  double shininess = std::numeric_limits<double>::infinity();
  double glass = 0;    ///< share that is reflected or refracted by Fresnel's equations
  double index = 1.5;  ///< of refraction behind the front, over that before it; > 0
  double emitted = 0;  ///< radiance of the front, >= 0 and not subnormal
};

/// The material of triangles that have none.
inline const Material matt{};

/// Throws std::invalid_argument, naming the material, unless all numbers are finite (except the shininess) and in range,
/// and the shares add up to at most 1.
void check(const Material& material);

/// The materials of a mesh's triangles.
struct Materials {
  std::vector<Material> all = {};               ///< none: every triangle is matt
  std::vector<std::uint16_t> of_triangle = {};  ///< indices into `all`; none: every triangle has the first material

  [[nodiscard]] const Material& of(std::size_t triangle) const {
    if (all.empty()) return matt;
    return of_triangle.empty() ? all.front() : all[of_triangle[triangle]];
  }
};

/// Throws std::invalid_argument as check(Material), and unless each of so many triangles has a material.
void check(const Materials& materials, std::size_t triangles);

}  // namespace detp::sim
