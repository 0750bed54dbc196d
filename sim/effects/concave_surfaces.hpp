#pragma once

#include <span>
#include <stop_token>

#include "effect.hpp"

namespace detp::sim {

/// Whether discs would be shadowed by their own surface if rays ended at their first intersection with it.
///
/// The value is the share of discs that have a neighbour in front of their tangent plane; if both faces count, on either side of it, because
/// a surface that is convex from outside is concave for light that arrives inside, as in a glass ball. With z its height over the
/// plane and r its distance from the disc's centre, the neighbour is in front if
///
///     z > 0.02 d                              for r <= d
///     z (d/r)² > 0.02 d  and  z < r/√2        for r between d and 4d
///
///   where  d   the disc's radius
///
/// The second line takes the surface as a parabola through the centre and the neighbour; samples are mostly farther
/// apart than d. It leaves out neighbours that lie above the disc rather than beside it.
///
/// Measured on at most 256 discs, on fewer if the value is far from the effect's threshold. Their neighbours are
/// searched among the 16 discs before and after them in the array, and the 8 before and after them on the curve through
/// at most 8192 sampled discs. So neighbours are missed where the array has no spatial order, as that of points placed
/// at random by area, if 8192 sampled discs are much more than 4d apart.
///
/// Needs no rays, so that it can be known before photon paths are made. Throws Stopped if a stop was requested.
[[nodiscard]] Finding concavity(std::span<const Disc> discs, bool front_facing = true,
                                const std::stop_token& stop = {});

/// The same, with the discs already sampled.
[[nodiscard]] Finding concavity(std::span<const Disc> discs, const CurveSample& sample, bool front_facing = true,
                                const std::stop_token& stop = {});

}  // namespace detp::sim
