#include "near_triangles.hpp"

#include <cmath>

#include "detp/sim/base/embree.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"

namespace detp::sim {
namespace {

/// In units of the half diagonal of the mesh's box: covers the rounding of coordinates to single precision.
constexpr float box_margin = 4e-7F;

/// What Embree passes to our callbacks. Facets are in scene units.
struct PointQuery {
  const DistinctFacets* distinct;
  FunctionRef<void(std::uint32_t)> visit;
};

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

struct NearTriangles::Embree {
  DistinctFacets distinct;
  glm::dvec3 centre{0.0};
  double scale = 1;
  embree::Owned<RTCDevice> device{rtcNewDevice(nullptr)};
  embree::Owned<RTCScene> scene;

  Embree(const Mesh& mesh, const std::stop_token& stop) : distinct(distinct_facets(facets_of(mesh, stop), stop)) {
    if (const Box box = used_box(mesh); !box.empty()) {
      centre = box.centre();
      const glm::dvec3 size = box.size();
      const double half = 0.5 * std::hypot(size.x, size.y, size.z);
      if (half > 0) scale = half;
    }
    embree::require_no_error(device);
    scene.reset(rtcNewScene(device.get()));
    const embree::Owned<RTCGeometry> geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(distinct.facets.size()));
    rtcSetGeometryUserData(geometry.get(), this);
    const auto bounds = [](const RTCBoundsFunctionArguments* arguments) {
      const auto& self = *static_cast<const Embree*>(arguments->geometryUserPtr);
      self.bound(self.distinct.facets[arguments->primID], *arguments->bounds_o);
    };
    rtcSetGeometryBoundsFunction(geometry.get(), bounds, nullptr);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(scene.get(), geometry.get());
    embree::commit(device.get(), scene.get(), stop, "building a tree over the scene's triangles");
  }

  [[nodiscard]] glm::dvec3 own(const glm::dvec3& point) const { return (point - centre) / scale; }

  void bound(const Facet& facet, RTCBounds& bounds) const {
    Box box;
    for (const glm::dvec3& corner : {facet.corner, facet.corner + facet.first, facet.corner + facet.second})
      box.include(own(corner));
    bounds.lower_x = static_cast<float>(box.low.x) - box_margin;
    bounds.lower_y = static_cast<float>(box.low.y) - box_margin;
    bounds.lower_z = static_cast<float>(box.low.z) - box_margin;
    bounds.upper_x = static_cast<float>(box.high.x) + box_margin;
    bounds.upper_y = static_cast<float>(box.high.y) + box_margin;
    bounds.upper_z = static_cast<float>(box.high.z) + box_margin;
  }
};

NearTriangles::NearTriangles(const Mesh& mesh, const std::stop_token& stop) {
  const DefaultFloatingPoint mode;
  const Stopwatch watch;
  embree_ = std::make_unique<Embree>(mesh, stop);
  seconds_ = watch.seconds();
}

NearTriangles::~NearTriangles() = default;

void NearTriangles::visit(const glm::dvec3& point, double distance, FunctionRef<void(std::uint32_t)> visit) const {
  const glm::dvec3 own = embree_->own(point);
  const double reach = distance / embree_->scale;
  // Single precision displaces a point far from the mesh by more than the box_margin.
  const double far = std::max({1.0, std::abs(own.x), std::abs(own.y), std::abs(own.z)});
  RTCPointQuery query{static_cast<float>(own.x), static_cast<float>(own.y), static_cast<float>(own.z), 0,
                      static_cast<float>((reach + box_margin * far) * (1 + 1e-6))};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  PointQuery ours{&embree_->distinct, visit};
  const auto found = [](RTCPointQueryFunctionArguments* arguments) {
    const auto& of = *static_cast<const PointQuery*>(arguments->userPtr);
    of.visit(of.distinct->triangles[arguments->primID]);
    return false;  // the distance does not change
  };
  rtcPointQuery(embree_->scene.get(), &query, &context, found, &ours);
}

const Facet& NearTriangles::facet(std::uint32_t triangle) const {
  return embree_->distinct.facets[embree_->distinct.places[triangle]];
}

bool NearTriangles::is_met(std::uint32_t triangle) const {
  const auto& [facets, triangles, places] = embree_->distinct;
  return triangle < places.size() && places[triangle] != no_facet && triangles[places[triangle]] == triangle;
}

}  // namespace detp::sim
