#pragma once

#include <cstdint>
#include <memory>

#include "detp/sim/scene/scene.hpp"
#include "detp/sim/search/index.hpp"

namespace detp::sim {

inline constexpr std::uint64_t paths_by_default = 64;

/// The irradiance at the discs' centres by backward paths: no bias, no radius, no photons.
///
///     E = (Σ over paths of front and back)/N        N: paths of each disc, on each side that counts
///
/// Path k of disc i is a function of the seed and (i, k) alone. Hits are paths that brought light. Standard errors are those of the
/// mean of the paths; infinite, for not known, if fewer than two brought light; weak where a few bring most of it. Bounds by the rules of
/// irradiance.hpp, with paths for photons; infinite if no path of any disc brought light. Light that no backward path finds is
/// missing: sim/reference/missed_light.hpp.
///
/// The scene must outlive the index; the problem needs no rays. Throws std::invalid_argument for a scene without triangles or
/// light or with invalid ones, and for paths outside of 1 … 2³²; std::runtime_error if Embree fails; Stopped.
[[nodiscard]] std::unique_ptr<Index> prepare_gather(const Scene& scene, std::uint64_t paths, std::uint64_t seed,
                                                    const RunOptions& options);

/// A scene with colours as it is in one of its bands, without colours.
[[nodiscard]] Scene in_band(const Scene& scene, int band);

/// The same search; of a scene with colours (Scene::rgb) in three bands, one after the other. A band without light is 0.
[[nodiscard]] Outcome gather(const Problem& problem, const Scene& scene, std::uint64_t paths, std::uint64_t seed,
                             const RunOptions& options);

}  // namespace detp::sim
