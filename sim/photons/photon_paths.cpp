#include "photon_paths.hpp"

#include <algorithm>
#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "photon_rounds.hpp"
#include "photon_tracer.hpp"

namespace detp::sim {
namespace {

constexpr std::uint64_t block_size = 256;  // number of photons that one thread traces at a time

std::vector<PhotonPieces> trace_round(const PhotonTracer& tracer, std::uint64_t first, std::uint64_t photons,
                                      const std::stop_token& stop) {
  std::vector<PhotonPieces> blocks((photons + block_size - 1) / block_size);
  sim::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
    const std::uint64_t start = first + i * block_size;
    blocks[i] = tracer.trace(start, std::min(start + block_size, first + photons), stop);
  });
  return blocks;
}

}  // namespace

std::vector<Ray> photon_paths(const Scene& scene, std::size_t count, std::uint64_t seed, const std::stop_token& stop) {
  return photon_paths(scene, count, seed, caster_for(scene, stop), stop);
}

std::vector<Ray> photon_paths(const Scene& scene, std::size_t count, std::uint64_t seed,
                              std::shared_ptr<const RayCaster> caster, const std::stop_token& stop) {
  const DefaultFloatingPoint mode;
  const PhotonTracer tracer(scene, seed, std::move(caster));
  PhotonRounds rounds(scene.name, count);
  std::vector<Ray> rays;
  std::uint64_t traced = 0;
  std::uint64_t emitted = 1;
  StopCheck check(stop, "copying photon paths");
  try {
    while (rays.size() < count) {
      const std::uint64_t photons = rounds.next(rays.size());
      for (const PhotonPieces& block : trace_round(tracer, traced, photons, stop)) {
        const std::size_t taken = std::min(block.rays.size(), count - rays.size());
        if (taken == 0) continue;
        rays.insert(rays.end(), block.rays.begin(), block.rays.begin() + static_cast<std::ptrdiff_t>(taken));
        emitted = block.photons[taken - 1] + 1;
        check.after(taken);
      }
      traced += photons;
    }
    for_each_checked(std::span(rays), check, [&](Ray& ray) { ray.power /= static_cast<double>(emitted); });
  } catch (const Stopped&) {
    stopped_tracing(rays.size(), count);
  }
  return rays;
}

}  // namespace detp::sim
