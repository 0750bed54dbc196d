#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "detp/sim/scene/scene.hpp"

namespace detp::sim {

/// Photon paths. A photon leaves the light and flies to the first surface. There it is either absorbed, or reflected
/// diffusely; the probability of reflection is the scene's albedo (Russian roulette: a photon's power stays the same).
///
/// Returns exactly `count` rays, one for each straight piece of a path, photon by photon; a photon's pieces keep their
/// order. Each ray has the power 1 / (photons emitted), so the light's flux is 1. Let gap be 1e-5 of the box's
/// diagonal. A piece starts `gap` beyond the point where the photon was (halfway to the surface, if that is nearer than
/// 2 gap), and ends `gap` beyond the surface. So it crosses the discs in the tangent plane where it ends, but not the
/// discs where it starts. A piece that leaves the scene ends on the sphere around the box's centre whose radius is the
/// box's diagonal; it is dropped if it starts outside this sphere. A photon has at most 1000 pieces, so that an albedo
/// of 1 terminates.
///
/// The result depends on the seed alone, not on the number of threads. Throws std::invalid_argument for a scene without
/// light, triangles or box, for an albedo outside [0, 1], for a light that is not finite or has no area, and if
/// 1000 + 100 · `count` photons gave too few pieces. Throws std::runtime_error if Embree fails, and Stopped if a stop
/// was requested.
[[nodiscard]] std::vector<Ray> photon_paths(const Scene& scene, std::size_t count, std::uint64_t seed,
                                            const std::stop_token& stop = {});

}  // namespace detp::sim
