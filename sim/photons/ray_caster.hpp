#pragma once

#include <optional>
#include <stop_token>

#include "detp/sim/base/function_ref.hpp"
#include "detp/sim/scene/facet.hpp"
#include "detp/sim/scene/item_tree.hpp"
#include "detp/sim/scene/mesh.hpp"

namespace detp::sim {

/// Finds the first triangle that a ray meets. A tree of boxes finds candidates in single precision. Double precision decides
/// which candidate is met, and where. So the point found lies on the surface within rounding, however small the
/// triangle is, and a ray that starts on a surface does not meet it again.
///
/// Works in coordinates of its own, in which the mesh's box is centred at the origin with a half diagonal of 0.5 … 1.
/// So a tiny scene, or one far from the origin, does no harm. Safe to use from many threads.
class RayCaster {
 public:
  /// Copies what it needs of the mesh. Triangles without area are never met. The box must hold every used vertex, and
  /// must not be a single point. Throws Stopped if a stop was requested.
  RayCaster(const Mesh& mesh, const Box& box, const std::stop_token& stop = {});

  /// Conversion from scene coordinates to the caster's own, and back.
  [[nodiscard]] glm::dvec3 to_caster(const glm::dvec3& point) const { return (point - centre_) / scale_; }
  [[nodiscard]] glm::dvec3 to_scene(const glm::dvec3& point) const { return centre_ + scale_ * point; }
  /// One of the caster's own units, in scene units; a power of two.
  [[nodiscard]] double scale() const { return scale_; }

  struct Intersection {
    double distance;    ///< > 0, in the caster's own units
    glm::dvec3 normal;  ///< of the triangle, unit length
    std::uint32_t triangle;
  };

  /// The first triangle that the ray meets within a distance, except triangle `from`, where it starts; nullopt if there is none. Of
  /// triangles at the same distance, returns the one with the lowest number. Origin and unit direction are in the
  /// caster's own coordinates.
  [[nodiscard]] std::optional<Intersection> first_intersection(const glm::dvec3& origin, const glm::dvec3& direction,
                                                               std::optional<std::uint32_t> from = std::nullopt,
                                                               double within = unbounded) const;

  /// Calls visit(triangle, facet) for each triangle with area that may have a point within `distance` of a point, in no particular
  /// order; of triangles with the same corners only for the one with the lowest number. All in the caster's own units.
  void visit_near(const glm::dvec3& point, double distance,
                  FunctionRef<void(std::uint32_t triangle, const Facet& facet)> visit) const;

 private:
  glm::dvec3 centre_;
  double scale_;
  DistinctFacets distinct_;
  std::optional<ItemTree> tree_;
};

}  // namespace detp::sim
