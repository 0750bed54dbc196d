#include "embree_mode.hpp"

#include <array>

namespace detp::validate {

std::string call_of(const EmbreeMode& mode) {
  constexpr std::array suffixes{"1", "8", "16", "1M", "NM"};
  const std::string stem = mode.query == EmbreeQuery::intersect ? "rtcIntersect" : "rtcOccluded";
  return stem + suffixes[static_cast<std::size_t>(mode.rays)];
}

std::string name(EmbreeQuality quality) {
  constexpr std::array names{"low", "medium", "high"};
  return names[static_cast<std::size_t>(quality)];
}

std::string describe(const EmbreeMode& mode) {
  return call_of(mode) + ", " + name(mode.quality) + (mode.coherent ? ", coherent" : ", incoherent");
}

std::vector<EmbreeMode> all_embree_modes() {
  std::vector<EmbreeMode> modes;
  for (const auto quality : {EmbreeQuality::low, EmbreeQuality::medium, EmbreeQuality::high})
    for (const auto query : {EmbreeQuery::intersect, EmbreeQuery::occluded})
      for (const auto rays : {EmbreeRays::one, EmbreeRays::packet_8, EmbreeRays::packet_16, EmbreeRays::stream_of_rays,
                              EmbreeRays::stream_of_packets})
        for (const bool coherent : {false, true}) modes.push_back({query, rays, quality, coherent});
  return modes;
}

}  // namespace detp::validate
