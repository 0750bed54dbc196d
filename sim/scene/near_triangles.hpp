#pragma once

#include <optional>
#include <stop_token>

#include "detp/sim/base/function_ref.hpp"
#include "facet.hpp"
#include "item_tree.hpp"
#include "mesh.hpp"

namespace detp::sim {

/// Finds the triangles near a point. A tree of boxes finds candidates in single precision, with a margin.
class NearTriangles {
 public:
  /// The mesh must outlive this. Throws Stopped if a stop was requested.
  explicit NearTriangles(const Mesh& mesh, const std::stop_token& stop = {});

  /// Calls visit(triangle) for each triangle with area that may have a point within `distance` of `point`; of triangles with the
  /// same corners only the one with the lowest number. In no particular order. Safe to use from many threads.
  void visit(const glm::dvec3& point, double distance, FunctionRef<void(std::uint32_t triangle)> visit) const;

  /// Whether a photon can meet the triangle: it has area, and is the first with its corners.
  [[nodiscard]] bool is_met(std::uint32_t triangle) const;
  /// The facet of a triangle that is_met, in scene units.
  [[nodiscard]] const Facet& facet(std::uint32_t triangle) const;
  /// Seconds that making this took.
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  /// In units in which the mesh's box has a half diagonal of 1 around the origin.
  [[nodiscard]] glm::dvec3 own(const glm::dvec3& point) const { return (point - centre_) / scale_; }

  DistinctFacets distinct_;  ///< in scene units
  glm::dvec3 centre_{0.0};
  double scale_ = 1;
  std::optional<ItemTree> tree_;
  double seconds_ = 0;
};

}  // namespace detp::sim
