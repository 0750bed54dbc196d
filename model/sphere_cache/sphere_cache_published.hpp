#pragma once

#include <cstdint>

#include "detp/model/vocabulary/vocabulary.hpp"

/// The sphere cache as the paper has it: S₀ holds everything; S_i, of radius r_i = r₀Qⁱ, keeps the rays of S_{i-1} that
/// cross it, and is made anew where the next sample leaves it. Samples are visited along the Lebesgue curve.
///
///   symbols  n_R, n_P   rays, samples;   Q   radius ratio;   k   index of the innermost sphere
///            t, u       time of one ray-sphere, one ray-disc test
///
/// All are closed forms, evaluated in O(1) whatever k.
///
/// Valid      any Q between 0 and 1, i and k <= 9e18, n_R and n_P <= 1e18, t and u any finite double >= 0.
/// Limits     results beyond the largest double saturate there; below the smallest normal one they are right to one
///            space between doubles.
/// Accuracy   relative error at most 2.3e-16 against 100 digits, over 10⁶ inputs log-uniform over that domain (1 - Q
///            down to 2⁻⁵³, Q down to 2⁻¹⁰⁷⁴: tests/model/hard_cases); monotone where the formula is. It rests on long
///            double's 64 bits.
/// Throws     std::invalid_argument for numbers out of range: see vocabulary/checks.hpp.
namespace detp::model::published {

/// n_i = n_R Q^{2i}: expected rays in S_i (eqs 4, 15). True wherever S_i lies, if it lies inside S₀ and the rays are
/// lines of μ_ℓ: eq (4) stands uncorrected.
[[nodiscard]] double rays_in_sphere(double rays, RadiusRatio ratio, std::int64_t i);

/// m_i = Q^{-3i}: how often S_i is rebuilt (eqs 10, 11, 17). Saturates at the largest double.
///
/// Far off: it takes r_i for r_i - d and the radius for the side of a cell, ignores the jumps of the curve, and holds
/// only for samples that fill a volume. Counted, over min(n_P, m_i), in the sweep (validate/sweep/results.md): 0.7 to
/// 35 000 times as many in a volume, the most where r_i is near d; 0.1 to 3100 times on surfaces. See rebuild_law.hpp.
[[nodiscard]] double rebuilds(RadiusRatio ratio, std::int64_t i);

/// t_i = t n_{i-1}: the time of one rebuild of S_i (eqs 5, 16).
[[nodiscard]] double rebuild_cost(double rays, RadiusRatio ratio, std::int64_t i, double sphere_test);

/// T_R = Σ_{i=1..k} min(n_P, m_i) t_i (eq 12), as two geometric sums: before and after Q^{-3i} reaches n_P.
[[nodiscard]] double rebuild_time(const Workload& workload, RadiusRatio ratio, std::int64_t k, double sphere_test);

/// T_R = t n_R (n_P^{1/3} - 1) / (Q²(1 - Q)) for few samples at a distance of about d (eq 19).
[[nodiscard]] double rebuild_time_few_samples(const Workload& workload, RadiusRatio ratio, double sphere_test);

/// T_I = u n_k n_P: every disc against the rays of the innermost sphere (eq 8).
[[nodiscard]] double intersect_time(const Workload& workload, RadiusRatio ratio, std::int64_t k, double disc_test);

/// Expected counts behind T_R and T_I: Σ min(n_P, m_i) rebuilds, their sphere tests, and the disc tests.
[[nodiscard]] Counts<double> counts(const Workload& workload, RadiusRatio ratio, std::int64_t k);

/// The same cache without sorting, which the paper says gains nothing over testing every disc: u n_R n_P (section 4).
[[nodiscard]] double unsorted_time(const Workload& workload, double disc_test);

}  // namespace detp::model::published
