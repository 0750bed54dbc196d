#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>

#include "detp/sim/photons/ray_caster.hpp"
#include "detp/sim/scene/scene.hpp"
#include "effect.hpp"

namespace detp::sim {

/// How far photon paths go on through the surfaces where they end if concave surfaces are on, over the discs' radius.
/// On @cornell, @interior, @tree and the bunny, 1, 2, 4 and no limit were compared with the light that lands around each
/// sample: figures in README.md.
inline constexpr double overshoot_over_radius = 2;

/// Whether photon paths should go on through the surfaces where they end, measured on about 2048 pieces of paths.
///
/// Paths that end at their first intersection miss those parts of discs that lie behind the surface: on concave surfaces
/// and in corners, and all around on rough ones. Paths that go on miss no disc, but reach discs behind thin sheets. The
/// value is what going on by 2 d would add of the first kind, less what it would add of the second, in power of hits,
/// over that of all hits of paths that end at once. A crossing beyond the surface is of the first kind if the disc's
/// centre is in front of the surface's plane, or less than 0.05 d behind it, and the photon meets the same side of disc and surface: the front of
/// both, or the back of both.
///
/// If concavity (concave_surfaces.hpp) finds too few discs with a neighbour in front, no path is traced, and the value is
/// 0. Otherwise the cost is that of tracing the paths and of a tree of boxes over the discs. Throws as photon_paths.
[[nodiscard]] Finding self_shadow(const Scene& scene, std::shared_ptr<const RayCaster> caster,
                                  std::span<const Disc> discs, bool front_facing, std::uint64_t seed,
                                  const std::stop_token& stop = {});

/// How far photon paths go on beyond surfaces if the effect is on.
[[nodiscard]] double overshoot_for(std::span<const Disc> discs);

}  // namespace detp::sim
