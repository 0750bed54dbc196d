#pragma once

#include <span>
#include <stop_token>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/geometry/geometry.hpp"
#include "detp/sim/technique/technique.hpp"

namespace detp::validate {

/// Structural rigor: the expected value of every count of a candidate, computed from the discs without rays.
///
///     octree, grid, bsp    builds the index and sums its nodes' surface areas (structural_index.cpp)
///     sphere cache         walks along the sorted samples (structural_walk.cpp)
///     hierarchies          builds the tree and sums its spheres' surface areas, or the shares of lines that its boxes
///                          list (structural_hierarchy.cpp)
///     brute force          n_R n_P tests
///     hits                 n_R Σ d²/(2 r₀²), half of this if only hits on fronts count (model/lines/line_measure.hpp)
///
/// Takes about as long as building the index or walking along the samples.
///
/// Valid      isotropic lines through the enclosing sphere of the discs; sphere cache: along the Morton curve.
/// Accuracy   12 scenes (four built-in, eight meshes) of 20 000 samples, d 0.4 % and 2 % of the scene's side, 300 000
///            lines, octrees of depth 3, 6, 8, grids of 5, 40, 128 cells a side, caches Q 0.5, 0.65, 0.8. References,
///            placements, rebuilds, sorted: exact. Median and largest deviation of expected from observed counts, which
///            include the noise of the lines (0.4 and 1.8 % of hits): nodes 0.2, 0.7 %; steps 0.3, 0.5 %; disc tests of
///            an index 0.5, 1.4 %, of the cache 0.5, 1.6 %; sphere tests 0.3, 1.0 %. Second comparison, on the four
///            built-in scenes, d 1 %, 200 000 lines, each technique (hierarchies too) with its best parameters: no
///            deviation above 1.3 %, of rays listed 0.7 %.
/// Throws     std::invalid_argument for no discs, malformed discs, a number of rays or parameters out of range,
///            sphere-cache-published (its walk loses rays), a sphere cache not in the Morton order, bvh, ray-map,
///            photon-map, and an octree that is not searched top-down or front to back; std::length_error if an index
///            would not fit in memory; sim::Stopped if a stop was requested.
[[nodiscard]] Counts<double> structural_counts(std::span<const sim::Disc> discs, double rays,
                                               const Valid<Candidate>& candidate, const std::stop_token& stop = {},
                                               bool front_facing = false, Engine engine = Engine::simd);

/// Structural counts for the discs of a problem. The rays of the problem are not used.
[[nodiscard]] Counts<double> structural_counts(const sim::Problem& problem, double rays,
                                               const Valid<Candidate>& candidate, const std::stop_token& stop = {},
                                               bool front_facing = false, Engine engine = Engine::simd);

}  // namespace detp::validate
