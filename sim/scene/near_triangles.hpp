#pragma once

#include <memory>
#include <stop_token>

#include "detp/sim/base/function_ref.hpp"
#include "facet.hpp"
#include "mesh.hpp"

namespace detp::sim {

/// Finds the triangles near a point. Embree finds candidates in single precision, with a margin.
class NearTriangles {
 public:
  /// The mesh must outlive this. Throws std::runtime_error if Embree fails; Stopped if a stop was requested.
  explicit NearTriangles(const Mesh& mesh, const std::stop_token& stop = {});
  ~NearTriangles();
  NearTriangles(const NearTriangles&) = delete;
  NearTriangles& operator=(const NearTriangles&) = delete;

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
  struct Embree;
  std::unique_ptr<Embree> embree_;
  double seconds_ = 0;
};

}  // namespace detp::sim
