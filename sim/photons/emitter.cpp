#include "emitter.hpp"

#include <stdexcept>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/unit_vector.hpp"

namespace detp::sim {
namespace {

void require_finite_vector(const char* what, const glm::dvec3& vector) {
  for (int axis = 0; axis < 3; ++axis) require_finite(what, vector[axis]);
}

glm::dvec3 checked_normal(const PointLight& light) {
  require_finite_vector("position of the point light", light.position);
  return glm::dvec3{0.0};
}

glm::dvec3 checked_normal(const AreaLight& light) {
  require_finite_vector("corner of the area light", light.corner);
  require_finite_vector("first edge of the area light", light.edge_u);
  require_finite_vector("second edge of the area light", light.edge_v);
  const glm::dvec3 normal = unit_or_zero(glm::cross(unit_or_zero(light.edge_u), unit_or_zero(light.edge_v)));
  if (normal == glm::dvec3{0.0}) throw std::invalid_argument("area light has no area; its edges must not be parallel");
  return normal;
}

}  // namespace

Emitter::Emitter(const Light& light)
    : light_(light), normal_(std::visit([](const auto& kind) { return checked_normal(kind); }, light)) {}

PhotonStart Emitter::photon(const std::array<double, 4>& random) const {
  if (const auto* point = std::get_if<PointLight>(&light_))
    return {point->position, uniform_direction(random[2], random[3])};
  const auto& area = std::get<AreaLight>(light_);
  return {area.corner + random[0] * area.edge_u + random[1] * area.edge_v,
          cosine_direction(normal_, random[2], random[3])};
}

}  // namespace detp::sim
