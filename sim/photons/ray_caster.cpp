#include "ray_caster.hpp"

#include <cmath>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/scene/facet.hpp"

namespace detp::sim {
namespace {

// These lengths are in the caster's own units, in which the mesh's coordinates are below 1. The tree's rays start within
// start_radius of the origin, so single precision displaces no point of a ray by more than 1e-6.
constexpr float box_slack = 2e-6F;
constexpr float distance_slack = 1e-5F;
constexpr double start_radius = 1.5;

/// Distance along the ray to the sphere around (0, 0, 0) with radius start_radius, which contains the whole mesh. 0 if
/// the ray starts inside the sphere; negative if the ray never enters it.
double entry(const glm::dvec3& origin, const glm::dvec3& direction) {
  if (glm::dot(origin, origin) <= start_radius * start_radius) return 0;
  const double along = -glm::dot(origin, direction);
  const glm::dvec3 nearest = origin + along * direction;
  const double rest = start_radius * start_radius - glm::dot(nearest, nearest);
  return along < 0 || rest < 0 ? -1 : along - std::sqrt(rest);
}

/// The smallest power of two above half the box's diagonal. Scaling by a power of two is exact.
double caster_unit(const Box& box) {
  const glm::dvec3 half = 0.5 * box.size();
  return std::exp2(std::ilogb(std::hypot(half.x, half.y, half.z)) + 1);
}

}  // namespace

RayCaster::RayCaster(const Mesh& mesh, const Box& box, const std::stop_token& stop)
    : centre_(box.centre()), scale_(caster_unit(box)) {
  const DefaultFloatingPoint mode;
  std::vector<Facet> facets;
  facets.reserve(mesh.triangles.size());
  StopCheck check(stop, "copying triangles");
  for_each_checked(std::span(mesh.triangles), check, [&](const auto& corners) {
    const auto& [a, b, c] = corners;
    facets.push_back(
        make_facet(to_caster(mesh.positions[a]), to_caster(mesh.positions[b]), to_caster(mesh.positions[c])));
  });
  distinct_ = distinct_facets(std::move(facets), stop);
  tree_.emplace(facet_tree(
      distinct_.facets, [](const glm::dvec3& corner) { return corner; }, box_slack, stop));
}

std::optional<RayCaster::Intersection> RayCaster::first_intersection(const glm::dvec3& origin,
                                                                     const glm::dvec3& direction,
                                                                     std::optional<std::uint32_t> from,
                                                                     double within) const {
  const double skipped = entry(origin, direction);
  if (skipped < 0) return std::nullopt;
  const std::uint32_t excepted = from ? distinct_.places[*from] : no_facet;
  const float farthest = static_cast<float>(within - skipped) + distance_slack;
  if (farthest < 0) return std::nullopt;
  float limit = farthest;
  std::uint32_t nearest = no_facet;
  double nearest_distance = unbounded;
  tree_->along(glm::vec3(origin + skipped * direction), glm::vec3(direction), farthest, [&](std::uint32_t facet) {
    if (facet == excepted) return limit;
    const double distance = crossing(origin, direction, distinct_.facets[facet]);
    const bool nearer = distance < nearest_distance || (distance == nearest_distance && facet < nearest);
    if (!nearer || distance == unbounded) return limit;
    nearest_distance = distance;
    nearest = facet;
    // The slack covers rounding: facets at the same distance must still be found.
    limit = std::min(limit, static_cast<float>(distance - skipped) + distance_slack);
    return limit;
  });
  if (nearest == no_facet || nearest_distance > within) return std::nullopt;
  return Intersection{nearest_distance, distinct_.facets[nearest].normal, distinct_.triangles[nearest]};
}

void RayCaster::visit_near(const glm::dvec3& point, double distance,
                           FunctionRef<void(std::uint32_t triangle, const Facet& facet)> visit) const {
  tree_->near(glm::vec3(point), static_cast<float>(distance) + box_slack,
              [&](std::uint32_t facet) { visit(distinct_.triangles[facet], distinct_.facets[facet]); });
}

}  // namespace detp::sim
