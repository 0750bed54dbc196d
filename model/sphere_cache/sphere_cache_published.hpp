#pragma once

#include <cstdint>

#include "detp/model/vocabulary/vocabulary.hpp"

/// The sphere cache as in the paper. S₀ contains everything. S_i has the radius r_i = r₀Qⁱ; its list holds the rays of
/// S_{i-1}'s list that cross S_i. S_i is rebuilt when the next sample is outside it. Samples are visited along the
/// Morton curve (the paper: Lebesgue curve).
///
///   symbols  n_R, n_P   rays, samples;   Q   radius ratio;   k   index of the innermost sphere
///            t, u       time of one ray-sphere, one ray-disc test
///
/// All are closed forms, evaluated in O(1) for any k.
///
/// Valid      any Q between 0 and 1, i and k <= 9e18, n_R and n_P <= 1e18, t and u any finite double >= 0.
/// Limits     results above the largest double saturate; below the smallest normal double the error is at most one
///            spacing of doubles.
/// Accuracy   relative error at most 2.3e-16 compared with 100 digits, over 10⁶ inputs log-uniform over that domain
///            (1 - Q down to 2⁻⁵³, Q down to 2⁻¹⁰⁷⁴: tests/model/hard_cases); monotone where the formula is. Needs long
///            double's 64-bit mantissa.
/// Throws     std::invalid_argument for numbers out of range: see vocabulary/checks.hpp.
namespace detp::model::published {

/// n_i = n_R Q^{2i}: expected rays in S_i (eqs 4, 15). Right for any place of S_i inside S₀ if the rays are lines of
/// μ_ℓ; eq (4) needs no correction.
[[nodiscard]] double rays_in_sphere(double rays, RadiusRatio ratio, std::int64_t i);

/// m_i = Q^{-3i}: how often S_i is rebuilt (eqs 10, 11, 17). Saturates at the largest double.
///
/// The formula is far off. It uses r_i instead of r_i - d and the radius instead of the side of a cell, ignores the
/// jumps of the curve, and holds only for samples in a volume. The counted rebuilds were 0.7 to 35 000 times min(n_P,
/// m_i) in a volume (most where r_i is near d), and 0.1 to 3100 times on surfaces (validate/sweep/results.md). See
/// rebuild_law.hpp.
[[nodiscard]] double rebuilds(RadiusRatio ratio, std::int64_t i);

/// t_i = t n_{i-1}: the time of one rebuild of S_i (eqs 5, 16).
[[nodiscard]] double rebuild_cost(double rays, RadiusRatio ratio, std::int64_t i, double sphere_test);

/// T_R = Σ_{i=1..k} min(n_P, m_i) t_i (eq 12), as two geometric sums: before and after Q^{-3i} reaches n_P.
[[nodiscard]] double rebuild_time(const Valid<Workload>& workload, RadiusRatio ratio, std::int64_t k,
                                  double sphere_test);

/// T_R = t n_R (n_P^{1/3} - 1) / (Q²(1 - Q)) for few samples, about d apart (eq 19).
[[nodiscard]] double rebuild_time_few_samples(const Valid<Workload>& workload, RadiusRatio ratio, double sphere_test);

/// T_I = u n_k n_P: every disc against the rays of the innermost sphere (eq 8).
[[nodiscard]] double intersect_time(const Valid<Workload>& workload, RadiusRatio ratio, std::int64_t k,
                                    double disc_test);

/// Expected counts from which T_R and T_I follow: Σ min(n_P, m_i) rebuilds, their sphere tests, and the disc tests.
[[nodiscard]] Counts<double> counts(const Valid<Workload>& workload, RadiusRatio ratio, std::int64_t k);

/// Time of the sphere cache if samples are not sorted: u n_R n_P. The paper says that this is no faster than testing
/// every disc (section 4).
[[nodiscard]] double unsorted_time(const Valid<Workload>& workload, double disc_test);

}  // namespace detp::model::published
