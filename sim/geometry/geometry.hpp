#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>

/// The shapes of the simulation, in double precision and scene units.
namespace detp::sim {

inline constexpr double unbounded = std::numeric_limits<double>::infinity();

/// Bound on every coordinate and every distance in a problem, so that squares do not overflow.
inline constexpr double largest_coordinate = 1e100;

/// A photon path or a line.
struct Ray {
  glm::dvec3 origin{0.0};
  glm::dvec3 direction{0.0, 0.0, 1.0};  ///< unit length
  double length = unbounded;            ///< of the segment from the origin; `unbounded` means the whole line, both ways
  double power = 1;  ///< flux that the ray carries; irradiance is the sum of powers divided by the disc's area

  [[nodiscard]] bool is_line() const { return length == unbounded; }
};

/// The disc of a sample, in the tangent plane.
struct Disc {
  glm::dvec3 centre{0.0};
  glm::dvec3 normal{0.0, 0.0, 1.0};  ///< unit length
  double radius = 1;                 ///< > 0
};

struct Sphere {
  glm::dvec3 centre{0.0};
  double radius = 1;
};

/// Axis-aligned box. Starts empty; `include` grows it.
struct Box {
  glm::dvec3 low{unbounded};
  glm::dvec3 high{-unbounded};

  void include(const glm::dvec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  [[nodiscard]] bool empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
  [[nodiscard]] glm::dvec3 size() const { return high - low; }
  [[nodiscard]] glm::dvec3 centre() const { return low + 0.5 * (high - low); }
  [[nodiscard]] double longest_side() const { return std::max({size().x, size().y, size().z}); }
};

/// For a sample that is at no vertex of a file.
inline constexpr std::uint32_t no_vertex = UINT32_MAX;

/// A point of a surface where irradiance is wanted.
struct Sample {
  glm::dvec3 position{0.0};
  glm::dvec3 normal{0.0, 0.0, 1.0};  ///< unit length
  std::uint32_t vertex = no_vertex;  ///< of the file, from 0
};

}  // namespace detp::sim
