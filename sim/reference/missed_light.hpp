#pragma once

#include <cstdint>
#include <memory>
#include <stop_token>

#include "detp/sim/geometry/paths.hpp"
#include "detp/sim/photons/ray_caster.hpp"
#include "detp/sim/scene/scene.hpp"

/// The light that backward paths do not find (misses_light): that of photons from lights without extent (point, spot, directional)
/// which the first surface does not scatter diffusely. What such a photon brings to its second and later surfaces is missed;
/// all else is found.
namespace detp::sim {

/// The rays that carry missed light, of the first `photons` photons of photon_paths in this scene with this seed; the caster is of the
/// scene's mesh. Powers are those of EmittedPhoton divided by `photons`; other photons are not followed. Runs on all threads of the caller's
/// arena. Throws as PhotonTracer.
[[nodiscard]] Paths missed_light(const Scene& scene, std::shared_ptr<const RayCaster> caster, std::uint64_t seed,
                                 std::uint64_t photons, const std::stop_token& stop = {});

/// A usual number for missed_share: if they meet none, at most about 0.02 % is missed.
inline constexpr std::uint64_t photons_of_share = std::uint64_t{1} << 14;

struct MissedShare {
  double share = 0;        ///< of the power of all landings
  double upper_bound = 0;  ///< one-sided, 95 %, by the rules of sim/search/irradiance.hpp; 0 if no light can be missed
  std::uint64_t photons = 0;  ///< that were traced
};

/// The share of missed light in all light that lands on surfaces, each landing counted, by so many photons (> 0). Without misses_light(scene) exactly 0, and no
/// photon is traced. `caster` may be null: then it is made. Runs on all threads of the caller's arena. Throws as PhotonWalk.
/// After a stop request nothing is known: the bound is 1, and there are no photons.
[[nodiscard]] MissedShare missed_share(const Scene& scene, std::shared_ptr<const RayCaster> caster, std::uint64_t seed,
                                       std::uint64_t photons, const std::stop_token& stop = {});

}  // namespace detp::sim
