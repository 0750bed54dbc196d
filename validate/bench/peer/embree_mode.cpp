#include <array>

#include "detp/model/vocabulary/technique.hpp"
#include "embree_peer.hpp"

namespace detp::validate {
namespace {

constexpr bool has_embree_streams = DETP_EMBREE == 3;

}  // namespace

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
  if (!has_embree) return modes;
  for (const auto quality : {EmbreeQuality::low, EmbreeQuality::medium, EmbreeQuality::high})
    for (const auto query : {EmbreeQuery::intersect, EmbreeQuery::occluded})
      for (const auto rays : {EmbreeRays::one, EmbreeRays::packet_8, EmbreeRays::packet_16, EmbreeRays::stream_of_rays,
                              EmbreeRays::stream_of_packets})
        for (const bool coherent : {false, true})
          if (has_embree_streams || (rays != EmbreeRays::stream_of_rays && rays != EmbreeRays::stream_of_packets))
            modes.push_back({query, rays, quality, coherent});
  return modes;
}

#if DETP_EMBREE == 0

struct EmbreePeer::Threads {};

EmbreePeer::EmbreePeer(int, const std::string&) { throw std::runtime_error("this detp was built without Embree"); }

EmbreePeer::~EmbreePeer() = default;

PeerOutcome EmbreePeer::run(std::span<const sim::Ray>, std::span<const sim::Disc>, const EmbreeMode&,
                            const std::stop_token&) const {
  return {};
}

#endif

}  // namespace detp::validate
