#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "detp/sim/scene/scene.hpp"

namespace detp::sim {

/// Photon paths: light leaves the scene's light, is followed to the first surface, and bounces off diffusely with the
/// scene's albedo as probability (Russian roulette: the power of a photon stays the same).
///
/// Gives exactly `count` rays, one for each straight piece, photon after photon; a photon's pieces keep their order.
/// Each carries the power 1 / (photons emitted), so that the light's flux is 1. A piece starts `gap` further on than
/// the point it comes from (halfway, if it is shorter than 2 gap) and ends `gap` beyond the surface it meets, gap =
/// 1e-5 of the box's diagonal: so it crosses the discs in the tangent plane where it lands, and not those where it
/// starts. A piece that leaves the scene ends where it leaves the sphere around the box (twice its half diagonal), or
/// is dropped if it starts beyond. A photon has at most 1000 pieces, lest an albedo of 1 goes on for ever.
///
/// Determined by the seed alone, whatever the number of threads. Throws std::invalid_argument for a scene without
/// light, triangles or box, for an albedo outside [0, 1] or a light that is not finite or has no area, and if after
/// 1000 + 100 count photons too few pieces were found. Throws Stopped if a stop was requested.
[[nodiscard]] std::vector<Ray> photon_paths(const Scene& scene, std::size_t count, std::uint64_t seed,
                                            const std::stop_token& stop = {});

}  // namespace detp::sim
