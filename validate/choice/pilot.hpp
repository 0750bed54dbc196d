#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "choice.hpp"
#include "detp/model/vocabulary/parameters.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/geometry/geometry.hpp"

/// Chooses by a sample of rays, through parts of the index; what is sampled, and what is known of box trees before that.
namespace detp::validate {

/// The time of a run in units of some 10 to 50 ns, roughly.
[[nodiscard]] double work_of(double rays, double discs);

/// The number of rays that a pilot samples: 64 to 2048, the more the longer the search will take.
[[nodiscard]] std::size_t pilot_size(double rays, double discs);

/// A stratified sample of the rays, of pilot_size.
[[nodiscard]] std::vector<sim::Ray> pilot_sample(std::span<const sim::Ray> rays, std::size_t discs);

/// `count` rays such as the workload describes, for a pilot:
///
///     lines      uniform isotropic lines through the sphere
///     segments   pieces of such lines: of each line's chord of the samples' box (grown by d) and the sphere, the same share, at a uniform
///                place on it; their mean length is the workload's
///
/// Source     segments: our choice. Real paths end on surfaces and come from lights: lists near a light are longer.
/// Throws     std::invalid_argument for a sphere out of range, as sim::LineField.
[[nodiscard]] std::vector<sim::Ray> structural_sample(const sim::Sphere& sphere, const Valid<Workload>& workload,
                                                      std::size_t count);

/// p/u, the time for placing a disc in a leaf over that for testing a ray against a disc, by the simd engine with AVX-512.
inline constexpr double usual_placing = 128;

/// A good box tree for that many rays and discs, without a look at them: fan-out 4, and leaves of
///
///     24 (n_P/n_R)^0.3 (p/(128 u))^0.35, rounded to a power of two from 8 to 512
///
/// Few rays do not pay for small leaves; slow tests do. `placing` is p/u; out of 1 … 1024, the nearest of the two.
///
/// Source     fitted to exact counts, priced with calibrated unit costs, of fan-outs 4 to 32 with leaves 4 to 512, on
///            lines and photon paths, 10² to 10⁵ rays, radii of 0.25 to 4 % of the scene: @courtyard and @tree. The
///            unit costs are those of one machine with AVX-512, AVX2, SSE4 and scalar code (p/u = 133, 73, 27 and 11).
/// Accuracy   measured time over that of the fastest of 35 shapes (fan-outs 2 to 8, leaves of 4 to 256), on the 21 workloads by which the
///            fan-out was set (Zen 5, AVX-512): 6 % more in the geometric mean, at most 14 %; with fan-out 8 7.6 and 28 %.
/// Throws     std::invalid_argument unless both numbers are from 1 to 1e18, and if `placing` is NaN.
[[nodiscard]] BoxTreeParameters usual_shape(double rays, double discs, double placing = usual_placing);

/// The least counts of a search of `rays` rays down any box tree over the problem's discs, as expected from `sample`, a part of
/// these rays. A leaf's box contains the spheres around its discs, so a ray that crosses such a sphere is tested against the
/// disc. 64 discs, evenly spaced in the array, and at most 128 rays are tried.
[[nodiscard]] Counts<double> least_box_tree_counts(const sim::Problem& problem, std::span<const sim::Ray> sample,
                                                   double rays);

/// `choose` with rigor pilot or structural; `question` has its rays and their number. `costs` as for `choose`.
///
/// The shapes of box trees are compared by sim::PilotedDiscs, brute force by its exact counts, other techniques by
/// compare_others. Brute force is chosen if it takes less time than sorting and placing the discs and the least search that
/// any box tree needs; then there is no pilot. After the pilot, the discs are sorted, and it is chosen only if it is faster
/// than the rest of the run.
[[nodiscard]] Choice choose_by_sample(const Question& question, Rigor rigor, const Valid<CostTable>& costs);

/// choose_again after choose_by_sample; `question` has the other radius and number of rays.
[[nodiscard]] Choice sample_again(const Choice& choice, const Question& question, double radius_ratio,
                                  const Valid<CostTable>& costs);

}  // namespace detp::validate
