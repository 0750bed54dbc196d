#pragma once

#include <cstdint>

#include "detp/model/vocabulary/vocabulary.hpp"

/// The radius ratio Q and the number of spheres k at which the sphere cache is fastest, by the corrected T.
///
/// T(Q, k) has many local minima, at values of Q only a few percent apart: each sphere's rebuilds depend on its size
/// relative to the curve's cells. T also has kinks at the knots of the tables. Often r_k is a few d at the best k.
///
/// For one ratio, all numbers of spheres are evaluated in one pass over its spheres. The search starts with 64 intervals,
/// equal in ln ln 1/Q. Three times it halves those with an end at which T is close to the best T so far: within 20, 10
/// and 5 %. Around the six lowest minima, Brent's method follows T with the number of spheres of the minimum. So at most 514
/// ratios are evaluated, and 60 by Brent's method; mostly about 180 in all.
namespace detp::model {

/// The result of a search. If k is 0, Q has no effect and is published_ratio. best_ratio_and_stop and
/// good_ratio_below return k = 0 if d >= 0.98 r₀, because no sphere would hold a disc.
struct BestRatio {
  double ratio = 0;          ///< Q
  std::int64_t spheres = 0;  ///< k; 0: no sphere, each disc is tested with all rays
  double time = 0;           ///< T at (Q, k) less time_at_any_ratio, in the unit of the costs
};

/// The part of T that does not depend on Q and k: the costs of rays, hits and the start, and of handling discs that are
/// in no cache of the processor.
[[nodiscard]] double time_at_any_ratio(const Valid<Workload>& workload, const Valid<UnitCosts>& costs);

/// A good ratio in little time: the best of eight fixed ones, each with its best number of spheres. Stops after the first
/// ratio at which the best T so far exceeds 3 times `time`. Then the best T exceeds `time`, too.
///
/// Accuracy   if it does not stop, T exceeds that of best_ratio_and_stop by 1.1 % in the median, 5 % at the 90th percentile, at most 14 %
///            (300 random workloads: n_R, n_P 10² … 10⁸, d/r₀ 10⁻⁴ … 0.1, D 2 … 3, copies 0 … 2 t, rebuilds 0 … 50 t).
///            With the single ratio of optimal_ratio, T exceeds it by 16 % in the median, at most 95 %.
/// Cost       about 30 µs, 4 µs a ratio.
/// Throws     as best_ratio_and_stop.
[[nodiscard]] BestRatio good_ratio_below(const Valid<Workload>& workload, const Valid<UnitCosts>& costs, double time);

/// Minimises T jointly over 0.02 <= Q <= 0.98 and k = 1 … most_spheres with r_k >= d.
///
/// Accuracy   T exceeds the smallest T by 2e-7 (relative) in the median, 4e-6 at the 90th percentile, 1.4e-4 at the 99th, at
///            most 3e-3: where a narrow minimum lies between two ratios (900 random workloads, compared with a branch and
///            bound that was within 6e-11 of fine grids). T itself is 2.7 % off counts. There is no proved lower bound.
/// Throws     std::invalid_argument for a workload or costs out of range.
[[nodiscard]] BestRatio best_ratio_and_stop(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                            std::int64_t most_spheres = 40);

/// The fastest number of spheres k for a given Q, 1 … 4096; 0 if no sphere holds a disc. Throws as
/// sphere_count and best_ratio_and_stop do.
[[nodiscard]] BestRatio best_stop(const Valid<Workload>& workload, const Valid<UnitCosts>& costs, RadiusRatio ratio);

/// The fastest Q, from 0.02 to 0.98, for a given k (0 … 9e18). If r_k < d for all these Q, the result is Q = 0.98. If
/// k is 0 or d >= r₀, the result has no sphere (k = 0).
/// Throws as best_ratio_and_stop does, and std::invalid_argument for k out of range.
[[nodiscard]] BestRatio best_ratio_for(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                       std::int64_t spheres);

/// Two numbers of spheres k for a sphere cache of ratio Q.
struct SphereStops {
  std::int64_t max = 0;   ///< number of spheres that can hold a disc, by the published or the corrected form
  std::int64_t best = 0;  ///< number of spheres with the least predicted time, by the same form; 0 if max is 0
};

/// Throws as sphere_count and best_stop do.
[[nodiscard]] SphereStops sphere_stops(const Workload& workload, const UnitCosts& costs, Form form, RadiusRatio ratio);

/// SphereStops::max alone, without the search for the best.
[[nodiscard]] std::int64_t own_spheres(const Workload& workload, Form form, RadiusRatio ratio);

/// The middle of the paper's recommendation, 0.6 to 0.7.
inline constexpr double published_ratio = 0.65;

// The radius ratio of the sphere cache in closed form.
//
// With many samples of dimension D, and spheres down to far below the scene's size, m_i ∝ r_i^{-D} and n_i ∝ r_i², so
// T_R ∝ Σ_i Q^{-(D-2)i-2}. The sum's largest terms are the innermost ones, whose size is fixed by d for any Q:
// T_R ∝ 1/(Q² (1 - Q^{D-2})), or 1/(Q² ln(1/Q)) for D = 2.
//
// This explains the published "0.6 to 0.7". The formula neglects the steps of k, finite n_P and the other terms of T;
// `best_ratio` includes them.

/// Q* = (2/D)^{1/(D-2)}: 2/3 for volumes, e^{-1/2} = 0.607 for surfaces.
///
/// Source     our derivation (dT_R/dQ = 0).
/// Accuracy   1.1e-16 compared with 100 digits, over 10⁶ values of D from 1 to 3, most of them close to 1, 2 or 3 (at
///            distances down to 1e-17); monotone (tests/model/hard_cases). Needs long double's 64-bit mantissa.
/// Throws     std::invalid_argument unless 1 <= D <= 3.
[[nodiscard]] double optimal_ratio(double dimension);

}  // namespace detp::model
