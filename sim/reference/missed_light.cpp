#include "missed_light.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "backward_paths.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/photons/photon_tracer.hpp"
#include "detp/sim/photons/photon_walk.hpp"
#include "detp/sim/search/irradiance.hpp"

namespace detp::sim {
namespace {

/// Power that a photon brings to surfaces, each landing counted.
struct LandedPower {
  double all = 0;
  double missed = 0;
};

struct CountLandings {
  std::uint64_t landings = 0;

  void piece(const Ray&, double) {}
  void met(std::uint32_t, double, bool) { ++landings; }
};

LandedPower landed_power(const PhotonWalk& walk, std::uint64_t photon) {
  CountLandings counter;
  walk.follow(photon, counter);
  const auto landings = static_cast<double>(counter.landings);
  const bool missed = landings > 1 && walk.is_missed_backwards(photon);
  return {walk.power(photon) * landings, missed ? walk.power(photon) * (landings - 1) : 0};
}

constexpr std::uint64_t photons_of_block = 1024;

/// The rays from number `first` on.
void append_from(std::ptrdiff_t first, const Paths& from, Paths& to) {
  const auto add = [first](const auto& source, auto& target) {
    target.insert(target.end(), source.begin() + first, source.end());
  };
  add(from.rays, to.rays);
  add(from.photons, to.photons);
  add(from.landings, to.landings);
  add(from.triangles, to.triangles);
}

}  // namespace

Paths missed_light(const Scene& scene, std::shared_ptr<const RayCaster> caster, std::uint64_t seed,
                   std::uint64_t photons, const std::stop_token& stop) {
  const DefaultFloatingPoint mode;
  Paths missed{.rays = {}, .photon_count = photons};
  if (!misses_light(scene)) return missed;
  const PhotonWalk walk(scene, seed, caster);
  const PhotonTracer tracer(scene, seed, std::move(caster));
  std::vector<Paths> blocks((photons + photons_of_block - 1) / photons_of_block);
  sim::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
    const std::uint64_t first = i * photons_of_block;
    const std::uint64_t last = std::min(first + photons_of_block, photons);
    for (std::uint64_t photon = first; photon < last; ++photon)
      if (walk.is_missed_backwards(photon)) append_from(1, tracer.trace(photon, photon + 1, stop), blocks[i]);
  });
  for (const Paths& block : blocks) append_from(0, block, missed);
  for (Ray& ray : missed.rays) ray.power /= static_cast<double>(photons);
  return missed;
}

MissedShare missed_share(const Scene& scene, std::shared_ptr<const RayCaster> caster, std::uint64_t seed,
                         std::uint64_t photons, const std::stop_token& stop) {
  const DefaultFloatingPoint mode;
  if (!misses_light(scene)) return {};
  std::vector<LandedPower> landed(photons);
  try {
    PhotonWalk walk(scene, seed, caster ? std::move(caster) : caster_for(scene, stop));
    walk.set_overshoot(0);
    sim::parallel_for(std::uint64_t{0}, photons, [&](std::uint64_t photon) {
      if (!stop.stop_requested()) landed[photon] = landed_power(walk, photon);
    });
  } catch (const Stopped&) {
  }
  if (stop.stop_requested()) return {.upper_bound = 1};
  double heaviest = 0;
  for (const LandedPower& one : landed) heaviest = std::max(heaviest, one.all);
  if (!(heaviest > 0)) return {0, 1, photons};
  double all = 0;  // in units of the heaviest, like all that follows
  double missed = 0;
  ErrorSums sums;
  for (const LandedPower& one : landed) {
    const double x = one.missed / heaviest;
    all += one.all / heaviest;
    missed += x;
    sums.squares += x * x;
    sums.largest = std::max(sums.largest, x);
  }
  const double bound = error_of_power(missed, sums, 1, static_cast<double>(photons)).upper_bound;
  return {missed / all, std::min(1.0, bound / all), photons};
}

}  // namespace detp::sim
