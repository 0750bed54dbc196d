#pragma once

#include <memory>
#include <span>
#include <stop_token>

#include "detp/sim/photons/ray_caster.hpp"
#include "detp/sim/scene/scene.hpp"
#include "effect.hpp"

namespace detp::sim {

/// How far photon paths go on through the surfaces where they end if concave surfaces are on, over the discs' radius.
inline constexpr double overshoot_over_radius = 2;

struct SelfShadow {
  Finding finding;
  double piece_seconds = 0;  ///< to trace one on one thread, by the wall clock; 0: too few were traced
};

/// Whether photon paths should go on through the surfaces where they end, measured on 4096 pieces of paths.
///
/// Paths that end at their first intersection miss those parts of discs that lie behind the surface: on concave surfaces
/// and in corners, and all around on rough ones. Paths that go on miss no disc, but reach discs behind thin sheets. The
/// value is what going on by 2 d would add of the first kind, less what it would add of the second, in power of hits,
/// over that of all hits of paths that end at once; plus 0.01, for where both are rare, going on is right. A crossing beyond the surface
/// is of the first kind if the disc's
/// centre is in front of the surface's plane, or less than 0.05 d behind it, and the photon meets the same side of disc and surface: the front of
/// both, or the back of both.
///
/// The discs of the pilot lie on the scene's triangles, spread by area, with d = 2 % of the scene's longest side. So the value is one of
/// the scene: it depends neither on the samples and the radius that are asked for nor on a seed, and irradiance is continuous in d. Cost:
/// tracing the pieces, and a tree of boxes over 8192 discs: 6 to 29 ms (README.md). Throws as photon_paths.
[[nodiscard]] SelfShadow self_shadow(const Scene& scene, std::shared_ptr<const RayCaster> caster, bool front_facing,
                                     const std::stop_token& stop = {});

/// How far photon paths go on beyond surfaces if the effect is on.
[[nodiscard]] double overshoot_for(std::span<const Disc> discs);

}  // namespace detp::sim
