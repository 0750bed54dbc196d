#include "near_triangles.hpp"

#include <cmath>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"

namespace detp::sim {
namespace {

/// In units of the half diagonal of the mesh's box: covers the rounding of coordinates to single precision.
constexpr float box_margin = 4e-7F;

std::vector<Facet> facets_of(const Mesh& mesh, const std::stop_token& stop) {
  StopCheck check(stop, "copying triangles");
  std::vector<Facet> facets;
  facets.reserve(mesh.triangles.size());
  for_each_checked(std::span(mesh.triangles), check, [&](const auto& corners) {
    const auto& [a, b, c] = corners;
    facets.push_back(make_facet(mesh.positions[a], mesh.positions[b], mesh.positions[c]));
  });
  return facets;
}

}  // namespace

NearTriangles::NearTriangles(const Mesh& mesh, const std::stop_token& stop) {
  const DefaultFloatingPoint mode;
  const Stopwatch watch;
  distinct_ = distinct_facets(facets_of(mesh, stop), stop);
  if (const Box box = used_box(mesh); !box.empty()) {
    centre_ = box.centre();
    const glm::dvec3 size = box.size();
    const double half = 0.5 * std::hypot(size.x, size.y, size.z);
    if (half > 0) scale_ = half;
  }
  tree_.emplace(facet_tree(
      distinct_.facets, [this](const glm::dvec3& corner) { return own(corner); }, box_margin, stop));
  seconds_ = watch.seconds();
}

void NearTriangles::visit(const glm::dvec3& point, double distance, FunctionRef<void(std::uint32_t)> visit) const {
  const glm::dvec3 at = own(point);
  const double reach = distance / scale_;
  // Single precision displaces a point far from the mesh by more than the box_margin.
  const double far = std::max({1.0, std::abs(at.x), std::abs(at.y), std::abs(at.z)});
  tree_->near(glm::vec3(at), static_cast<float>((reach + box_margin * far) * (1 + 1e-6)),
              [&](std::uint32_t facet) { visit(distinct_.triangles[facet]); });
}

const Facet& NearTriangles::facet(std::uint32_t triangle) const { return distinct_.facets[distinct_.places[triangle]]; }

bool NearTriangles::is_met(std::uint32_t triangle) const {
  const auto& [facets, triangles, places] = distinct_;
  return triangle < places.size() && places[triangle] != no_facet && triangles[places[triangle]] == triangle;
}

}  // namespace detp::sim
