#include "missed_light.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "backward_paths.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stopped.hpp"
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

}  // namespace

Paths missed_light(const Scene& scene, std::shared_ptr<const RayCaster> caster, std::uint64_t seed,
                   const Paths& traced) {
  const DefaultFloatingPoint mode;
  Paths missed{.rays = {}, .photon_count = traced.photon_count};
  if (!misses_light(scene)) return missed;
  const PhotonWalk walk(scene, seed, std::move(caster));
  const auto starts = [&](std::size_t i) { return i == 0 || traced.photons[i] != traced.photons[i - 1]; };
  std::vector<char> of_first(traced.rays.size());  // of each photon's first ray: whether later ones carry missed light
  sim::parallel_for(std::size_t{0}, of_first.size(), [&](std::size_t i) {
    if (starts(i)) of_first[i] = walk.is_missed_backwards(traced.photons[i]) ? 1 : 0;
  });
  bool is_missed = false;
  for (std::size_t i = 0; i < of_first.size(); ++i) {
    const bool first = starts(i);
    if (first) is_missed = of_first[i] != 0;
    if (first || !is_missed) continue;
    missed.rays.push_back(traced.rays[i]);
    missed.photons.push_back(traced.photons[i]);
    missed.landings.push_back(traced.landings[i]);
    missed.triangles.push_back(traced.triangles[i]);
  }
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
