#pragma once

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstddef>
#include <iterator>

/// Overloads of Embree's calls, selected by the type of the ray: RTCRay for rtcOccluded, RTCRayHit for rtcIntersect, or
/// packets of 8 or 16 of these.
namespace detp::validate::embree {

/// The ray, or packet of rays, in a call's argument.
template <class Packet>
auto& ray_of(Packet& packet) {
  if constexpr (requires { packet.ray; })
    return packet.ray;
  else
    return packet;
}

template <class Packet>
inline constexpr std::size_t width = sizeof(ray_of(*static_cast<Packet*>(nullptr)).id) / sizeof(unsigned);

/// Resets the hit, as rtcIntersect requires before a call.
inline void clear_hit(RTCRayHit& ray) { ray.hit.geomID = RTC_INVALID_GEOMETRY_ID; }
template <class Packet>
void clear_hit(Packet& packet) {
  if constexpr (requires { packet.hit; })
    std::fill(std::begin(packet.hit.geomID), std::end(packet.hit.geomID), RTC_INVALID_GEOMETRY_ID);
}

inline void query(RTCScene scene, RTCIntersectContext& context, RTCRay& ray) { rtcOccluded1(scene, &context, &ray); }
inline void query(RTCScene scene, RTCIntersectContext& context, RTCRayHit& ray) {
  rtcIntersect1(scene, &context, &ray);
}

inline void query(const int* valid, RTCScene scene, RTCIntersectContext& context, RTCRay8& packet) {
  rtcOccluded8(valid, scene, &context, &packet);
}
inline void query(const int* valid, RTCScene scene, RTCIntersectContext& context, RTCRayHit8& packet) {
  rtcIntersect8(valid, scene, &context, &packet);
}
inline void query(const int* valid, RTCScene scene, RTCIntersectContext& context, RTCRay16& packet) {
  rtcOccluded16(valid, scene, &context, &packet);
}
inline void query(const int* valid, RTCScene scene, RTCIntersectContext& context, RTCRayHit16& packet) {
  rtcIntersect16(valid, scene, &context, &packet);
}

inline void query_stream(RTCScene scene, RTCIntersectContext& context, RTCRay* rays, unsigned count) {
  rtcOccluded1M(scene, &context, rays, count, sizeof(RTCRay));
}
inline void query_stream(RTCScene scene, RTCIntersectContext& context, RTCRayHit* rays, unsigned count) {
  rtcIntersect1M(scene, &context, rays, count, sizeof(RTCRayHit));
}
inline void query_stream(RTCScene scene, RTCIntersectContext& context, RTCRay8* packets, unsigned count) {
  rtcOccludedNM(scene, &context, reinterpret_cast<RTCRayN*>(packets), 8, count, sizeof(RTCRay8));
}
inline void query_stream(RTCScene scene, RTCIntersectContext& context, RTCRayHit8* packets, unsigned count) {
  rtcIntersectNM(scene, &context, reinterpret_cast<RTCRayHitN*>(packets), 8, count, sizeof(RTCRayHit8));
}

}  // namespace detp::validate::embree
