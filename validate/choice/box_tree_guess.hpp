#pragma once

#include <span>

#include "detp/model/vocabulary/parameters.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/search/problem.hpp"

/// What is known of box trees before a pilot: a good shape, and a bound of their counts.
namespace detp::validate {

/// p/u, the time for placing a disc in a leaf over that for testing a ray against a disc, by the simd engine with AVX-512.
inline constexpr double usual_placing = 128;

/// A good box tree for that many rays and discs, without a look at them: fan-out 8, and leaves of
///
///     24 (n_P/n_R)^0.3 (p/(128 u))^0.35, rounded to a power of two from 8 to 512
///
/// Few rays do not pay for small leaves; slow tests do. `placing` is p/u; out of 1 … 1024, the nearest of the two.
///
/// Source     fitted to exact counts, priced with calibrated unit costs, of fan-outs 4 to 32 with leaves 4 to 512, on
///            lines and photon paths, 10² to 10⁵ rays, radii of 0.25 to 4 % of the scene: @courtyard and @tree. The
///            unit costs are those of one machine with AVX-512, AVX2, SSE4 and scalar code (p/u = 133, 73, 27 and 11).
/// Accuracy   time over that of the best of these shapes, priced alike, on four meshes that were not fitted: 0.6 to 0.8 %
///            more in the geometric mean, at most 4 to 8 %. Without p/u: 0.6, 0.5, 2.2 and 5.5 %, at most 4, 6, 15 and 29 %.
/// Throws     std::invalid_argument unless both numbers are from 1 to 1e18, and if `placing` is NaN.
[[nodiscard]] BoxTreeParameters usual_shape(double rays, double discs, double placing = usual_placing);

/// The least counts of a search of `rays` rays down any box tree over the problem's discs, as expected from `sample`, a part of
/// these rays. A leaf's box contains the spheres around its discs, so a ray that crosses such a sphere is tested against the
/// disc. 64 discs, evenly spaced in the array, and at most 128 rays are tried.
[[nodiscard]] Counts<double> least_box_tree_counts(const sim::Problem& problem, std::span<const sim::Ray> sample,
                                                   double rays);

}  // namespace detp::validate
