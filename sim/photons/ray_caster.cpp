#include "ray_caster.hpp"

#include <cmath>
#include <type_traits>

#include "detp/sim/base/embree.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/scene/facet.hpp"

namespace detp::sim {
namespace {

// These lengths are in the caster's own units, in which the mesh's coordinates are below 1. Embree's rays start within
// start_radius of the origin, so single precision displaces no point of a ray by more than 1e-6.
constexpr float box_slack = 2e-6F;
constexpr float distance_slack = 1e-5F;
constexpr double start_radius = 1.5;

/// Data that Embree passes to our callback with each candidate. Embree's own context must come first.
struct Query {
  RTCIntersectContext context;
  glm::dvec3 origin;
  glm::dvec3 direction;
  double skipped;                                   ///< distance from the ray's origin to the start of Embree's ray
  std::uint32_t from;                               ///< facet that the ray starts from, or no_facet
  std::uint32_t nearest = RTC_INVALID_GEOMETRY_ID;  ///< nearest facet so far
  double distance = unbounded;
};
static_assert(std::is_standard_layout_v<Query>);

void bound(const RTCBoundsFunctionArguments* arguments) {
  const Facet& facet = static_cast<const Facet*>(arguments->geometryUserPtr)[arguments->primID];
  Box box;
  for (const glm::dvec3& corner : {facet.corner, facet.corner + facet.first, facet.corner + facet.second})
    box.include(corner);
  RTCBounds& bounds = *arguments->bounds_o;
  bounds.lower_x = static_cast<float>(box.low.x) - box_slack;
  bounds.lower_y = static_cast<float>(box.low.y) - box_slack;
  bounds.lower_z = static_cast<float>(box.low.z) - box_slack;
  bounds.upper_x = static_cast<float>(box.high.x) + box_slack;
  bounds.upper_y = static_cast<float>(box.high.y) + box_slack;
  bounds.upper_z = static_cast<float>(box.high.z) + box_slack;
}

void intersect_facet(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  Query& query = *reinterpret_cast<Query*>(arguments->context);
  const std::uint32_t facet = arguments->primID;
  if (facet == query.from) return;
  const double distance =
      crossing(query.origin, query.direction, static_cast<const Facet*>(arguments->geometryUserPtr)[facet]);
  const bool nearer = distance < query.distance || (distance == query.distance && facet < query.nearest);
  if (!nearer || distance == unbounded) return;
  query.distance = distance;
  query.nearest = facet;
  // The slack covers Embree's rounding error: Embree must still report facets at the same distance.
  const float limit = static_cast<float>(distance - query.skipped) + distance_slack;
  RTCRayN_tfar(RTCRayHitN_RayN(arguments->rayhit, arguments->N), arguments->N, 0) = limit;
}

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

struct RayCaster::Embree {
  DistinctFacets distinct;
  embree::Owned<RTCDevice> device{rtcNewDevice(nullptr)};
  embree::Owned<RTCScene> scene;

  Embree(std::vector<Facet> all, const std::stop_token& stop) : distinct(distinct_facets(std::move(all), stop)) {
    embree::require_no_error(device);
    scene.reset(rtcNewScene(device.get()));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    const embree::Owned<RTCGeometry> geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(distinct.facets.size()));
    rtcSetGeometryUserData(geometry.get(), distinct.facets.data());
    rtcSetGeometryBoundsFunction(
        geometry.get(), [](const auto* arguments) { bound(arguments); }, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), intersect_facet);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(scene.get(), geometry.get());
    embree::commit(device.get(), scene.get(), stop, "building a tree over the scene's triangles");
  }
};

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
  embree_ = std::make_unique<Embree>(std::move(facets), stop);
}

RayCaster::~RayCaster() = default;

std::optional<RayCaster::Intersection> RayCaster::first_intersection(const glm::dvec3& origin,
                                                                     const glm::dvec3& direction,
                                                                     std::optional<std::uint32_t> from,
                                                                     double within) const {
  const double skipped = entry(origin, direction);
  if (skipped < 0) return std::nullopt;
  Query query{.context = {},
              .origin = origin,
              .direction = direction,
              .skipped = skipped,
              .from = from ? embree_->distinct.places[*from] : no_facet};
  rtcInitIntersectContext(&query.context);
  const glm::vec3 start(origin + skipped * direction);
  const glm::vec3 heading(direction);
  const float farthest = static_cast<float>(within - skipped) + distance_slack;
  if (farthest < 0) return std::nullopt;
  RTCRayHit ray{};
  ray.ray = {start.x, start.y, start.z, 0, heading.x, heading.y, heading.z, 0, farthest, 0xFFFFFFFFU, 0, 0};
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree_->scene.get(), &query.context, &ray);
  if (query.nearest == RTC_INVALID_GEOMETRY_ID || query.distance > within) return std::nullopt;
  return Intersection{query.distance, embree_->distinct.facets[query.nearest].normal,
                      embree_->distinct.triangles[query.nearest]};
}

void RayCaster::visit_near(const glm::dvec3& point, double distance,
                           FunctionRef<void(std::uint32_t triangle, const Facet& facet)> visit) const {
  struct Visit {
    const DistinctFacets& distinct;
    FunctionRef<void(std::uint32_t, const Facet&)> call;
  };
  Visit found{embree_->distinct, visit};
  RTCPointQuery query{static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z), 0,
                      static_cast<float>(distance) + box_slack};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  const auto tell = [](RTCPointQueryFunctionArguments* arguments) {
    const auto& to = *static_cast<const Visit*>(arguments->userPtr);
    to.call(to.distinct.triangles[arguments->primID], to.distinct.facets[arguments->primID]);
    return false;  // the distance does not change
  };
  rtcPointQuery(embree_->scene.get(), &query, &context, tell, &found);
}

}  // namespace detp::sim
