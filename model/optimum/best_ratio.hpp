#pragma once

#include <cstdint>

#include "detp/model/vocabulary/vocabulary.hpp"

/// The radius ratio Q and the number of spheres k at which the sphere cache is fastest, by the corrected T.
///
/// T(Q, k) has many local minima, at values of Q only a few percent apart: each sphere's rebuilds depend on its size
/// relative to the curve's cells. T also has kinks at the knots of the tables. Often r_k is a few d at the best k.
///
/// For one ratio, all numbers of spheres are evaluated in one pass over its spheres. The search starts with 128
/// intervals, equal in ln ln 1/Q and cut at the steps of k. It halves intervals in which T might be smaller than the
/// best T so far. Around each remaining minimum, T at 17 ratios shows which parts may hold a lower minimum, and Brent's
/// method finds this minimum. If T is almost constant (a cost of zero, extreme numbers of samples or spheres), no
/// interval can be excluded: the search then ends after most_evaluated_spheres spheres with the best result so far.
namespace detp::model {

/// The result of a search. If k is 0, Q has no effect and is published_ratio. best_ratio_and_stop and
/// good_ratio_and_stop return k = 0 if d >= 0.98 r₀, because no sphere would hold a disc.
struct BestRatio {
  double ratio = 0;                    ///< Q
  std::int64_t spheres = 0;            ///< k; 0: no sphere, each disc is tested with all rays
  double time = 0;                     ///< T at (Q, k) less time_at_any_ratio, in the unit of the costs
  std::int64_t evaluated_spheres = 0;  ///< spheres evaluated one by one by a search over Q
};

/// The part of T that does not depend on Q and k: the costs of rays, hits and the start, and of handling discs that are
/// in no cache of the processor.
[[nodiscard]] double time_at_any_ratio(const Valid<Workload>& workload, const Valid<UnitCosts>& costs);

inline constexpr std::int64_t most_evaluated_spheres = 16'000;

/// A good ratio in little time: the best of eight fixed ones, each with its best number of spheres.
///
/// Accuracy   T exceeds that of best_ratio_and_stop by 1.1 % in the median, 5 % at the 90th percentile, at most 14 %
///            (300 random workloads: n_R, n_P 10² … 10⁸, d/r₀ 10⁻⁴ … 0.1, D 2 … 3, copies 0 … 2 t, rebuilds 0 … 50 t).
///            With the single ratio of optimal_ratio, T exceeds it by 16 % in the median, at most 95 %.
/// Cost       about 30 µs, 4 µs a ratio.
/// Throws     as best_ratio_and_stop.
[[nodiscard]] BestRatio good_ratio_and_stop(const Valid<Workload>& workload, const Valid<UnitCosts>& costs);

/// The same, but stops after the first ratio at which the best T so far exceeds 3 times `time`. Then the best T exceeds
/// `time`, too.
[[nodiscard]] BestRatio good_ratio_below(const Valid<Workload>& workload, const Valid<UnitCosts>& costs, double time);

/// A better ratio than a good one: the best of `good` and of 176 ratios from 0.02 to 0.98, each with its best number of
/// spheres, and then Brent's method around the six lowest minima. Throws as best_ratio_and_stop.
[[nodiscard]] BestRatio better_ratio_and_stop(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                              const BestRatio& good);

/// Minimises T jointly over 0.02 <= Q <= 0.98 and k = 1 … most_spheres with r_k >= d.
///
/// Accuracy   T is within 6e-11 (relative) of the smallest T on at least 20 000 ratios, at the steps of k, and on ever
///            finer grids around all minima (750 random workloads). There is no proved lower bound for T: the largest
///            slope of T is estimated from experiments.
/// Cost       evaluates 4000 spheres in the mean, at 0.4 … 0.8 µs each; if most_spheres <= 40, at most
///            most_evaluated_spheres.
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

/// The middle of the paper's recommendation, 0.6 to 0.7.
inline constexpr double published_ratio = 0.65;

}  // namespace detp::model
