#include "embree_peer.hpp"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>

#include <numbers>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stopped.hpp"
#include "embree_discs.hpp"
#include "embree_tracer.hpp"

namespace detp::validate {
namespace {

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
  EmbreeOwned<RTCDevice> device;
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
  const EmbreeTracer tracer(scene.get(), rays, sphere_around(scene.get()), mode);
  oneapi::tbb::enumerable_thread_specific<Tallies> all(Tallies(discs.size()));
  const std::size_t blocks = (rays.size() + block - 1) / block;
  sim::parallel_for(Range(0, blocks, 1), [&](const Range& part) {
    for (std::size_t i = part.begin(); i < part.end() && !stop.stop_requested(); ++i)
      tracer.trace(i * block, std::min(rays.size(), (i + 1) * block), all.local());
  });
  PeerOutcome outcome = merged(all, discs);
  outcome.stopped = stop.stop_requested();
  require_no_embree_error(threads_->device.get());
  return outcome;
} catch (const sim::Stopped&) {
  return {.hits = {}, .irradiance = {}, .stopped = true};
}

}  // namespace detp::validate
