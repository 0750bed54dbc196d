#pragma once

#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/sim/base/stop_check.hpp"
#include "mesh.hpp"

/// The vertices of a mesh, each with one position and one normal, and the samples at them.
namespace detp::sim {

/// Faces that meet at a smaller angle are one surface (README.md).
inline constexpr double default_crease = 50;  // degrees; 0: flat

/// For each position the number of the first one with the same coordinates.
[[nodiscard]] std::vector<std::uint32_t> first_of_place(std::span<const glm::dvec3> positions, StopCheck& check);

/// Adds a notice with the number of vertices that no triangle uses, if there are any.
void note_unreferenced(const Mesh& mesh, Notices& notices);

/// Divides and joins the vertices of a mesh so that each has one position and one normal, and no two have both the same: whatever the
/// indexing of a file, the same surface has the same vertices. Returns a sample at each vertex that a triangle uses and that has a
/// normal.
///
/// Positions are equal if their coordinates are, normals if they are to 1e-6. A corner's normal is the mesh's own. Where the mesh has none or a
/// zero one, the corner's triangle is in a group with those to which it is joined around the position, over edges at which the
/// normals of both triangles differ by less than `crease`; the normal is that of the group:
///
///     n = Σ α_t n_t / |Σ α_t n_t|        α_t   angle of triangle t at the position,   n_t   its unit normal
///
///   (G. Thürmer, C. A. Wüthrich, "Computing vertex normals from polygonal facets", JGT 3(1), 1998), so that it does not matter how polygons are
///   divided. Where the sum cancels, it is the normal of the largest triangle.
///
/// Vertices are in the order of the first vertex of the file at their position and with their normal, then of their first triangle.
/// Unreferenced vertices are dropped. Vertices whose triangles all have no area have a zero normal and no sample, and add a notice
/// with their count. `crease` in degrees, in [0, 180]. Throws std::invalid_argument for another; Stopped if a stop was requested.
[[nodiscard]] std::vector<Sample> samples_at_vertices(Mesh& mesh, double crease, Notices& notices,
                                                      const std::stop_token& stop = {});

/// Multiplies points by a power of two, which is exact. Areas of what is scaled to about 1 neither vanish nor overflow.
class Scaling {
 public:
  explicit Scaling(int exponent = 0)
      : exponent_(exponent), factor_(std::abs(exponent) < 1000 ? std::ldexp(1.0, exponent) : 0) {}
  /// That which scales a coordinate of this size to at least 1 and less than 2; none for 0.
  static Scaling to_one(double size) { return Scaling(size > 0 ? -std::ilogb(size) : 0); }

  [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& point) const {
    if (factor_ > 0) return factor_ * point;
    return {std::scalbn(point.x, exponent_), std::scalbn(point.y, exponent_), std::scalbn(point.z, exponent_)};
  }
  [[nodiscard]] Scaling inverse() const { return Scaling(-exponent_); }

 private:
  int exponent_;
  double factor_;  ///< 0: perhaps beyond the range of doubles
};

}  // namespace detp::sim
