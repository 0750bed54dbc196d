#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "clip.hpp"
#include "mesh.hpp"
#include "vertices.hpp"

namespace detp::sim {

/// A triangle with an area, whose corners are of about the size 1.
struct Plate {
  std::array<glm::dvec3, 3> corners{};
  glm::dvec3 normal{0.0};      ///< of unit length
  double height = 0;           ///< the least
  double longest = 0;          ///< of the edges
  std::uint32_t triangle = 0;  ///< of the mesh
};

/// Coordinates in the plane of a plate: the plane as seen along an axis, with the plate counter-clockwise. They shorten
/// lengths, to no less than 0.57 of them.
class PlateView {
 public:
  explicit PlateView(const Plate& plate);

  [[nodiscard]] glm::dvec2 flat(const glm::dvec3& point) const {
    const glm::dvec3 from_origin = point - origin_;
    return {from_origin[u_], from_origin[v_]};
  }
  /// The point of the plane, from the plate's first corner.
  [[nodiscard]] glm::dvec3 offset(const glm::dvec2& flat) const {
    glm::dvec3 offset{0.0};
    offset[u_] = flat.x;
    offset[v_] = flat.y;
    offset[axis_] = slope_.x * flat.x + slope_.y * flat.y;
    return offset;
  }
  [[nodiscard]] glm::dvec3 point(const glm::dvec2& flat) const { return origin_ + offset(flat); }
  /// Another plate of the plane, also if it is turned.
  [[nodiscard]] FlatTriangle flat(const Plate& other) const;
  [[nodiscard]] FlatPolygon polygon(const Plate& plate) const;

 private:
  glm::dvec3 origin_;
  glm::dvec3 normal_;
  int axis_, u_, v_;
  glm::dvec2 slope_;
};

[[nodiscard]] bool is_turned(const Plate& one, const Plate& other);

/// Whether two plates lie in one plane and overlap: their overlap is wider than the slack, and its corners are within the
/// slack of both planes. The plates are higher than the slack.
[[nodiscard]] bool coincide(const Plate& one, const Plate& other, double slack);

/// The triangles of a mesh in the order in which they win where they coincide, scaled by a power of two.
struct Plates {
  std::vector<Plate> all = {};               ///< higher than the slack, without the repeated ones; the winners first
  std::vector<std::uint32_t> repeated = {};  ///< triangles with the same corners and face as an earlier one, which wins
  std::uint64_t emitting_repeated = 0;       ///< of them
  double slack = 0;                          ///< lengths up to this are 0
  Scaling scaled = Scaling{};                ///< the power of two
};

/// Throws Stopped if a stop was requested.
[[nodiscard]] Plates plates_of(const Mesh& mesh, const std::stop_token& stop);

}  // namespace detp::sim
