#pragma once

#include <string>
#include <vector>

/// The ways to make Embree find all hits.
namespace detp::validate {

/// A filter rejects every hit, so both kinds of query visit every hit. The queries differ in the order of visiting
/// nodes (nearest first, or any order) and in what a ray stores.
enum class EmbreeQuery { intersect, occluded };

/// Number and form of the rays in a call.
enum class EmbreeRays {
  one,               ///< rtcIntersect1
  packet_8,          ///< rtcIntersect8
  packet_16,         ///< rtcIntersect16
  stream_of_rays,    ///< rtcIntersect1M, 64 rays
  stream_of_packets  ///< rtcIntersectNM, 8 packets of 8
};

enum class EmbreeQuality { low, medium, high };

struct EmbreeMode {
  EmbreeQuery query = EmbreeQuery::intersect;
  EmbreeRays rays = EmbreeRays::one;
  EmbreeQuality quality = EmbreeQuality::medium;
  bool coherent = false;  ///< RTC_INTERSECT_CONTEXT_FLAG_COHERENT
  bool operator==(const EmbreeMode&) const = default;
};

/// The name of the function called: "rtcIntersect8".
[[nodiscard]] std::string call_of(const EmbreeMode& mode);

/// "low", "medium" or "high".
[[nodiscard]] std::string name(EmbreeQuality quality);

/// "rtcIntersect8, low, coherent".
[[nodiscard]] std::string describe(const EmbreeMode& mode);

/// All 60 modes.
[[nodiscard]] std::vector<EmbreeMode> all_embree_modes();

}  // namespace detp::validate
