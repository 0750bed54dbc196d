#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/sim/geometry/paths.hpp"
#include "detp/sim/scene/scene.hpp"
#include "light_ledger.hpp"

namespace detp::sim {

class RayCaster;

/// Paths of photons, and where their light went.
struct TracedPaths : Paths {
  LightLedger light = {};
};

enum class PhotonPowers {
  unbiased,  ///< the irradiance of these rays has no bias
  equal,     ///< that of many batches, weighted by their photons, has none; for photons of one light
  scaled  ///< as unbiased; but of many_photons or more, rays have their photons' powers, and the paths' scale divides them
};

/// Photon paths. A photon leaves a light (lights.hpp) and flies to the first surface. There its material absorbs or
/// scatters it by Russian roulette (scatter.hpp), so it keeps its power.
///
/// Returns at least `count` rays, one for each straight piece of a path, photon by photon, up to the end of the last photon's
/// path; a photon's pieces keep their order. With the rays come the numbers of their photons, the distances at which these
/// met a surface, and the number of photons emitted. Each ray has its photon's power: a light's flux, divided by the number of its photons expected among all that
/// were emitted; where these are few, with the shares below, or the last path would make a bias. Let gap be 1e-5 of the box's diagonal. A piece starts `gap` beyond the point where the photon was
/// (halfway to the surface, if that is nearer than 2 gap), and ends `gap` beyond the surface. So it crosses the discs in
/// the tangent plane where it ends, but not the discs where it starts. A piece that leaves the scene ends on the sphere
/// around the box's centre whose radius is the box's diagonal; it is dropped if it starts outside this sphere. A photon
/// has at most PhotonWalk::most_pieces, so that paths without absorption terminate: the ledger counts them.
///
/// A piece goes straight on through the surface where it ends, by Scene::overshoot at most: up to `gap` beyond the next
/// surface, or until it leaves the scene; not where the photon itself goes through (glass). So on a concave surface, or
/// in a corner, the surface does not shadow the parts of its own discs that lie behind it. The paper follows each path
/// to its second intersection (§2.1), which is an unbounded overshoot. The price: light reaches discs behind a sheet
/// without thickness.
///
/// The result depends on the seed alone, not on the number of threads. Throws std::invalid_argument for a scene without
/// light, triangles or box, for a light or material out of range, and if 1000 + 100 · `count` photons gave too few
/// pieces. Throws Stopped if a stop was requested.
[[nodiscard]] TracedPaths photon_paths(const Scene& scene, std::size_t count, std::uint64_t seed,
                                       const std::stop_token& stop = {});
/// The same, with a caster of the scene's mesh that was made before (photon_walk.hpp).
[[nodiscard]] TracedPaths photon_paths(const Scene& scene, std::size_t count, std::uint64_t seed,
                                       std::shared_ptr<const RayCaster> caster, const std::stop_token& stop = {},
                                       PhotonPowers powers = PhotonPowers::unbiased);

/// From so many photons on, shares are equal: the bias is below 1/64 of the noise.
inline constexpr std::uint64_t many_photons = 4096;

/// The share of the light that each of n photons stands for, if photons were traced until their paths had `wanted` pieces or
/// more. `pieces` has the number of each photon's pieces; without the last one there are fewer than `wanted`.
///
/// A share of 1/n each has a bias of about 1/n: the last photon tends to have a long path. The first photon alone would have none.
/// Its mean over all orders in which the same photons would have been traced to the same end (Rao and Blackwell) has none either.
/// These are the orders that end with one of the m photons with more than Σ pieces - wanted pieces:
///
///     1/(n - 1)                of the other photons
///     (1 - 1/m)/(n - 1)        of these m
///
/// Returns nothing for shares of 1/n: if m = n, and from many_photons on.
[[nodiscard]] std::vector<double> photon_shares(std::span<const std::uint64_t> pieces, std::uint64_t wanted);

}  // namespace detp::sim
