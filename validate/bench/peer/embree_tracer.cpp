#include "embree_tracer.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <iterator>
#include <stdexcept>
#include <type_traits>

namespace detp::validate {
namespace {

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

/// What depends on the type of the ray: RTCRay for rtcOccluded, RTCRayHit for rtcIntersect, or packets of 8 or 16 of these.
namespace calls {

/// The ray, or packet of rays, in a call's argument.
template <class Packet>
auto& ray_of(Packet& packet) {
  if constexpr (requires { packet.ray; })
    return packet.ray;
  else
    return packet;
}

template <class Packet>
constexpr std::size_t width = sizeof(ray_of(*static_cast<Packet*>(nullptr)).id) / sizeof(unsigned);

/// Resets the hit, as rtcIntersect requires before a call.
void clear_hit(RTCRayHit& ray) { ray.hit.geomID = RTC_INVALID_GEOMETRY_ID; }
template <class Packet>
void clear_hit(Packet& packet) {
  if constexpr (requires { packet.hit; })
    std::fill(std::begin(packet.hit.geomID), std::end(packet.hit.geomID), RTC_INVALID_GEOMETRY_ID);
}

}  // namespace calls

/// Data that Embree passes to the filter. Embree's own context must be the first member.
struct FilterData {
  sim::embree::Context context;
  const sim::Ray* rays;
  DiscTally* tallies;

  void add(unsigned ray, unsigned disc) const {
    tallies[disc].power += rays[ray].power;
    ++tallies[disc].hits;
  }
};
static_assert(std::is_standard_layout_v<FilterData>);

/// Records every hit, and rejects the hit so that the search continues. Embree's documentation recommends the context's
/// filter for collecting all hits of a ray. Rays may arrive in other packets, and in another order, than they were
/// sent. So a ray is identified by its id.
void collect_and_refuse(const RTCFilterFunctionNArguments* arguments) {
  const auto& collecting = *reinterpret_cast<const FilterData*>(arguments->context);
  if (arguments->N == 1) {
    collecting.add(reinterpret_cast<const RTCRay*>(arguments->ray)->id,
                   reinterpret_cast<const RTCHit*>(arguments->hit)->primID);
    arguments->valid[0] = 0;
    return;
  }
  for (unsigned lane = 0; lane < arguments->N; ++lane) {
    if (arguments->valid[lane] == 0) continue;
    collecting.add(RTCRayN_id(arguments->ray, arguments->N, lane), RTCHitN_primID(arguments->hit, arguments->N, lane));
    arguments->valid[lane] = 0;
  }
}

// Embree's documentation recommends coherent streams of around 64 rays.
[[maybe_unused]] constexpr std::size_t stream = 64;

class EmbreeTracer {
 public:
  EmbreeTracer(RTCScene scene, std::span<const sim::Ray> rays, const sim::Sphere& around)
      : scene_(scene), rays_(rays), maker_(around) {}

  /// RayHit, Packet8, Packet16: RTCRay… for rtcOccluded, RTCRayHit… for rtcIntersect.
  template <class RayHit, class Packet8, class Packet16>
  void trace(EmbreeRays form, const RayBlock& block, sim::embree::FilteredQueries& queries) const {
    switch (form) {
      case EmbreeRays::one:
        return send<RayHit, 1>(block, queries);
      case EmbreeRays::packet_8:
        return send<Packet8, 1>(block, queries);
      case EmbreeRays::packet_16:
        return send<Packet16, 1>(block, queries);
#if DETP_EMBREE == 3  // Embree 4 has no streams
      case EmbreeRays::stream_of_rays:
        return send<RayHit, stream>(block, queries);
      case EmbreeRays::stream_of_packets:
        return send<Packet8, stream / 8>(block, queries);
#else
      default:
        throw std::invalid_argument("this Embree has no streams of rays");
#endif
    }
  }

 private:
  /// Sends the rays in single rays or packets, some in each call.
  template <class Item, std::size_t in_a_call>
  void send(const RayBlock& block, sim::embree::FilteredQueries& queries) const {
    constexpr std::size_t width = calls::width<Item>;
    std::array<Item, in_a_call> sent{};
    for (std::size_t first = block.first; first < block.last;) {
      unsigned filled = 0;
      std::size_t count = 0;  // of rays in the last item
      for (; filled < in_a_call && first < block.last; first += width) {
        count = std::min(width, block.last - first);
        write(first, count, sent[filled++]);
      }
      if constexpr (in_a_call > 1) {
#if DETP_EMBREE == 3
        queries.trace_stream(scene_, sent.data(), filled);
#endif
      } else if constexpr (width > 1) {
        alignas(64) std::array<int, width> valid{};
        for (std::size_t lane = 0; lane < width; ++lane) valid[lane] = lane < count ? -1 : 0;
        queries.trace(scene_, valid.data(), sent.front());
      } else {
        queries.trace(scene_, sent.front());
      }
    }
  }

  /// Writes `count` rays from number `first` on into a ray or a packet. The other lanes are inactive as streams require: their
  /// rays end before they start.
  template <class Item>
  void write(std::size_t first, std::size_t count, Item& item) const {
    auto& rays = calls::ray_of(item);
    if constexpr (calls::width<Item> == 1) {
      maker_.write(rays_[first], static_cast<unsigned>(first), rays);
    } else {
      for (std::size_t lane = 0; lane < count; ++lane)
        maker_.write(rays_[first + lane], static_cast<unsigned>(first + lane), rays, lane);
      for (std::size_t lane = count; lane < calls::width<Item>; ++lane) {
        maker_.write(rays_[first], static_cast<unsigned>(first), rays, lane);
        rays.tfar[lane] = -1;
      }
    }
    calls::clear_hit(item);
  }

  RTCScene scene_;
  std::span<const sim::Ray> rays_;
  EmbreeRayMaker maker_;
};

}  // namespace

void trace(RTCScene scene, std::span<const sim::Ray> rays, const sim::Sphere& around, const EmbreeMode& mode,
           const RayBlock& block, std::vector<DiscTally>& tallies) {
  const FlushDenormals flush;
  FilterData collecting{.context = {}, .rays = rays.data(), .tallies = tallies.data()};
  sim::embree::init(collecting.context);
  sim::embree::FilteredQueries queries(collecting.context, collect_and_refuse, mode.coherent);
  const EmbreeTracer tracer(scene, rays, around);
  if (mode.query == EmbreeQuery::intersect)
    tracer.trace<RTCRayHit, RTCRayHit8, RTCRayHit16>(mode.rays, block, queries);
  else
    tracer.trace<RTCRay, RTCRay8, RTCRay16>(mode.rays, block, queries);
}

}  // namespace detp::validate
