#include "embree_peer.hpp"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>

#include <numbers>
#include <stdexcept>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/embree.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stopped.hpp"
#include "embree_tracer.hpp"

namespace detp::validate {

namespace {

RTCBuildQuality to_embree(EmbreeQuality quality) {
  if (quality == EmbreeQuality::low) return RTC_BUILD_QUALITY_LOW;
  return quality == EmbreeQuality::medium ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_HIGH;
}

/// The setting of the device; nothing for an empty name.
std::string setting_of(const std::string& instruction_set) {
  if (instruction_set.empty()) return {};
  if (instruction_set == "AVX3") return ",isa=avx512";
  if (instruction_set == "AVX2") return ",isa=avx2";
  if (instruction_set == "SSE4") return ",isa=sse4.2";
  throw std::invalid_argument("Embree has no counterpart of the instruction set " + detp::quoted(instruction_set) +
                              "; there are AVX3, AVX2, SSE4");
}

float* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t floats, std::size_t items) {
  return static_cast<float*>(rtcSetNewGeometryBuffer(geometry, type, 0, format, floats * sizeof(float), items));
}

/// A device that builds with `threads` threads, which have been started when the function returns. It uses the counterpart of one of our
/// instruction sets (AVX3: AVX-512; AVX2; SSE4: SSE4.2), or all that the machine has if this is empty.
sim::embree::Owned<RTCDevice> make_embree_device(int threads, const std::string& instruction_set) {
  const std::string settings = "threads=" + std::to_string(threads) + ",start_threads=1" + setting_of(instruction_set);
  sim::embree::Owned<RTCDevice> device(rtcNewDevice(settings.c_str()));
  sim::embree::require_no_error(device.get());
  return device;
}

/// A committed scene of oriented discs in single precision. Primitive i is disc i. Queries call the context's filter.
/// Throws sim::Stopped if a stop was requested, and as sim::embree::require_no_error does.
sim::embree::Owned<RTCScene> build_embree_discs(RTCDevice device, std::span<const sim::Disc> discs,
                                                EmbreeQuality quality, const std::stop_token& stop) {
  sim::embree::Owned<RTCScene> scene(rtcNewScene(device));
  rtcSetSceneFlags(scene.get(), sim::embree::filter_of_query);
  rtcSetSceneBuildQuality(scene.get(), to_embree(quality));
  const sim::embree::Owned<RTCGeometry> geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT));
  rtcSetGeometryBuildQuality(geometry.get(), to_embree(quality));
  float* vertex = new_buffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4, discs.size());
  float* normal = new_buffer(geometry.get(), RTC_BUFFER_TYPE_NORMAL, RTC_FORMAT_FLOAT3, 3, discs.size());
  sim::embree::require_no_error(device);
  sim::parallel_for(sim::ParallelRange(0, discs.size(), 4096), [&](const sim::ParallelRange& part) {
    for (std::size_t i = part.begin(); i < part.end(); ++i) {
      const sim::Disc& disc = discs[i];
      store_four(vertex + 4 * i, static_cast<float>(disc.centre.x), static_cast<float>(disc.centre.y),
                 static_cast<float>(disc.centre.z), static_cast<float>(disc.radius));
      for (int axis = 0; axis < 3; ++axis) normal[3 * i + axis] = static_cast<float>(disc.normal[axis]);
    }
  });
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene.get(), geometry.get());
  sim::embree::commit(device, scene.get(), stop, "building Embree's tree");
  return scene;
}

using Tallies = std::vector<DiscTally>;
using Range = sim::ParallelRange;

/// Number of rays or discs that one thread processes at a time: small enough to balance the load and to react to a stop
/// request, and a multiple of the number of rays in a stream.
constexpr std::size_t block = 4096;

sim::Sphere sphere_around(RTCScene scene) {
  RTCBounds bounds{};
  rtcGetSceneBounds(scene, &bounds);
  const glm::dvec3 low(bounds.lower_x, bounds.lower_y, bounds.lower_z);
  const glm::dvec3 high(bounds.upper_x, bounds.upper_y, bounds.upper_z);
  return {0.5 * (low + high), 0.5 * glm::distance(low, high) * (1 + 1e-6)};
}

PeerOutcome merged(oneapi::tbb::enumerable_thread_specific<Tallies>& all, std::span<const sim::Disc> discs) {
  PeerOutcome outcome{std::vector<std::uint64_t>(discs.size()), std::vector<double>(discs.size())};
  sim::parallel_for(Range(0, discs.size(), block), [&](const Range& part) {
    for (std::size_t i = part.begin(); i < part.end(); ++i) {
      for (const Tallies& tallies : all) {
        outcome.hits[i] += tallies[i].hits;
        outcome.irradiance[i] += tallies[i].power;
      }
      outcome.irradiance[i] /= std::numbers::pi * discs[i].radius * discs[i].radius;
    }
  });
  return outcome;
}

}  // namespace

struct EmbreePeer::Threads {
  Threads(int threads, const std::string& instruction_set)
      : count(threads), device(make_embree_device(threads, instruction_set)) {}

  int count;
  sim::embree::Owned<RTCDevice> device;
};

EmbreePeer::EmbreePeer(int threads, const std::string& instruction_set)
    : threads_(std::make_unique<Threads>(threads, instruction_set)) {}

EmbreePeer::~EmbreePeer() = default;

PeerOutcome EmbreePeer::run(std::span<const sim::Ray> rays, std::span<const sim::Disc> discs, const EmbreeMode& mode,
                            const std::stop_token& stop) const try {
  // A device builds with the largest number of threads of any existing device, even if it was created with fewer. So
  // the number is limited here.
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                          static_cast<std::size_t>(threads_->count));
  const auto scene = build_embree_discs(threads_->device.get(), discs, mode.quality, stop);
  const sim::Sphere around = sphere_around(scene.get());
  oneapi::tbb::enumerable_thread_specific<Tallies> all(Tallies(discs.size()));
  const std::size_t blocks = (rays.size() + block - 1) / block;
  sim::parallel_for(Range(0, blocks, 1), [&](const Range& part) {
    for (std::size_t i = part.begin(); i < part.end() && !stop.stop_requested(); ++i)
      trace(scene.get(), rays, around, mode, {i * block, std::min(rays.size(), (i + 1) * block)}, all.local());
  });
  PeerOutcome outcome = merged(all, discs);
  outcome.stopped = stop.stop_requested();
  sim::embree::require_no_error(threads_->device.get());
  return outcome;
} catch (const sim::Stopped&) {
  return {.hits = {}, .irradiance = {}, .stopped = true};
}

}  // namespace detp::validate
