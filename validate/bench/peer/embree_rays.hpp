#pragma once

#include <embree3/rtcore.h>

#include <glm/geometric.hpp>

#include "detp/sim/geometry/geometry.hpp"
#include "sse_state.hpp"

namespace detp::validate {

/// Converts rays to Embree's rays, in single precision. Embree's rays only go forwards. So a line, which is unbounded
/// both ways, becomes a ray that starts in front of all discs and ends behind them.
class EmbreeRayMaker {
 public:
  /// `around` must contain all discs.
  explicit EmbreeRayMaker(const sim::Sphere& around) : around_(around) {}

  /// The part of a ray that can hit a disc: its origin, and its length.
  struct RaySegment {
    glm::vec3 origin;
    float end;
  };

  [[nodiscard]] RaySegment segment_of(const sim::Ray& ray) const {
    if (!ray.is_line()) return {glm::vec3(ray.origin), static_cast<float>(ray.length)};
    const double start = glm::dot(around_.centre - ray.origin, ray.direction) - around_.radius;
    return {glm::vec3(ray.origin + start * ray.direction), static_cast<float>(2 * around_.radius)};
  }

  void write(const sim::Ray& ray, unsigned id, RTCRay& to) const {
    const RaySegment segment = segment_of(ray);
    const glm::vec3 direction(ray.direction);
    store_four(&to.org_x, segment.origin.x, segment.origin.y, segment.origin.z, 0);
    store_four(&to.dir_x, direction.x, direction.y, direction.z, 0);
    to.tfar = segment.end;
    to.mask = 0xFFFFFFFFU;
    to.id = id;
    to.flags = 0;
  }

  /// Writes the ray into one lane of a packet, RTCRay8 or RTCRay16.
  template <class Packet>
  void write(const sim::Ray& ray, unsigned id, Packet& to, std::size_t lane) const {
    const RaySegment segment = segment_of(ray);
    to.org_x[lane] = segment.origin.x;
    to.org_y[lane] = segment.origin.y;
    to.org_z[lane] = segment.origin.z;
    to.tnear[lane] = 0;
    to.dir_x[lane] = static_cast<float>(ray.direction.x);
    to.dir_y[lane] = static_cast<float>(ray.direction.y);
    to.dir_z[lane] = static_cast<float>(ray.direction.z);
    to.time[lane] = 0;
    to.tfar[lane] = segment.end;
    to.mask[lane] = 0xFFFFFFFFU;
    to.id[lane] = id;
    to.flags[lane] = 0;
  }

 private:
  sim::Sphere around_;
};

}  // namespace detp::validate
