#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "embree_mode.hpp"
#include "embree_rays.hpp"

namespace detp::validate {

/// The sums of one disc. They lie together, so that a hit touches only one cache line.
struct DiscTally {
  double power = 0;
  std::uint32_t hits = 0;
};

/// Traces rays through a scene of discs and adds up the power and hits of each disc.
class EmbreeTracer {
 public:
  EmbreeTracer(RTCScene scene, std::span<const sim::Ray> rays, const sim::Sphere& around, const EmbreeMode& mode)
      : scene_(scene), rays_(rays), maker_(around), mode_(mode) {}

  /// Traces rays first … last - 1 and adds their hits to `tallies`, which has one element for each disc. Thread-safe if
  /// each thread has its own tallies.
  void trace(std::size_t first, std::size_t last, std::vector<DiscTally>& tallies) const;

 private:
  template <class Packet>
  void write_packet(std::size_t first, std::size_t count, Packet& packet) const;
  template <class RayHit>
  void single_rays(std::size_t first, std::size_t last, RTCIntersectContext& context) const;
  template <class RayHit>
  void ray_streams(std::size_t first, std::size_t last, RTCIntersectContext& context) const;
  template <class Packet>
  void packets(std::size_t first, std::size_t last, RTCIntersectContext& context) const;
  template <class Packet>
  void packet_streams(std::size_t first, std::size_t last, RTCIntersectContext& context) const;
  template <class RayHit, class Packet8, class Packet16>
  void trace_as(std::size_t first, std::size_t last, RTCIntersectContext& context) const;

  RTCScene scene_;
  std::span<const sim::Ray> rays_;
  EmbreeRayMaker maker_;
  EmbreeMode mode_;
};

}  // namespace detp::validate
