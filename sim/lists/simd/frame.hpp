#pragma once

#include <array>

#include "detp/sim/search/problem.hpp"

/// The coordinates of rays and discs in floats: the scene is moved to the origin and scaled to about 1.
namespace detp::sim::stream {

/// u = 2⁻²⁴: half the distance from 1 to the next float.
inline constexpr double float_unit = 0x1p-24;

/// A sphere in the frame's coordinates, grown by Frame::margin.
struct FloatSphere {
  float centre[3];
  float radius;
};

/// Coordinates of the float kernels, and their error bounds. The bounds are proved in sim/lists/simd/floats.md.
struct Frame {
  glm::dvec3 centre{0.0};  ///< of S₀
  double scale = 1;        ///< a power of two: r₀ scale is in [½, 1)
  double slack = 0;        ///< Problem::slack in frame units
  float margin = 0;        ///< 64u + 2 slack: boxes and spheres are grown by this

  explicit Frame(const Problem& problem);

  /// Returns 32u + 128u d + 4 slack, d being the radius in frame units. A decision is repeated in double if it is
  /// within this band of the rim, or within half this band of an end.
  [[nodiscard]] float band(double radius) const {
    return static_cast<float>(32 * float_unit + 128 * float_unit * radius + 4 * slack);
  }

  [[nodiscard]] FloatSphere operator()(const Sphere& sphere) const;
  [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& point) const { return (point - centre) * scale; }
};

/// A ray in a list belongs to one of three classes, by the dominant axis of its direction. The coordinates of class k
/// are (x, y, z) = the axes (k + 1, k + 2, k) modulo 3. Its rays are x = p + a z, y = q + b z with |a|, |b| <= 1.
inline constexpr int classes = 3;

[[nodiscard]] constexpr std::array<int, 3> axes_of_class(int k) { return {(k + 1) % 3, (k + 2) % 3, k}; }

}  // namespace detp::sim::stream
