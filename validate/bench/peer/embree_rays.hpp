#pragma once

#include <embree3/rtcore.h>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include <glm/geometric.hpp>

#include "detp/sim/geometry/geometry.hpp"

namespace detp::validate {

/// While it exists, this thread treats denormal numbers as zero, as Embree's documentation strongly recommends. The
/// destructor restores the previous state, because the exact techniques rely on denormals.
class FlushDenormals {
 public:
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

#if defined(__SSE2__)
  FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | flush_to_zero | denormals_are_zero); }
  ~FlushDenormals() { _mm_setcsr(before_); }

 private:
  static constexpr unsigned flush_to_zero = 0x8000;
  static constexpr unsigned denormals_are_zero = 0x0040;
  unsigned before_;
#else
  FlushDenormals() = default;
#endif
};

/// Stores four floats at once, to an address divisible by 16. Embree loads the four floats as a vector. Its
/// documentation warns that four single stores would stall this load.
inline void store_four(float* to, float a, float b, float c, float d) {
#if defined(__SSE2__)
  _mm_store_ps(to, _mm_setr_ps(a, b, c, d));
#else
  to[0] = a;
  to[1] = b;
  to[2] = c;
  to[3] = d;
#endif
}

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
