#pragma once

#include <cstdint>

#include "detp/model/vocabulary/vocabulary.hpp"

/// The radius ratio Q and the stop k at which the sphere cache is fastest, by the corrected T.
///
/// T(Q, k) rises and falls with ln Q, for each sphere's rebuilds follow how its size compares with the curve's cells,
/// and has kinks where a table has a knot: its minima are many, and but a few percent apart. All stops of a ratio cost
/// one pass over its spheres. From 128 ratios and the steps of k, intervals are halved as long as T might fall below
/// the best within them. Around each minimum left, T at 17 ratios shows which parts may hold a lower one, and Brent's
/// method finds it. Stopping at r_k of a few d often beats going down to d. Where T is much the same everywhere (a cost
/// of zero, samples or spheres beyond all scale), there is nothing to halve for: the search ends after most_looked_at
/// spheres with the best so far.
namespace detp::model {

/// Where no sphere holds a disc (d > 0.98 r₀), k is 0 and Q the paper's, which does not matter then.
struct BestRatio {
  double ratio = 0;            ///< Q
  std::int64_t spheres = 0;    ///< k; 0: no sphere, each disc is tested with all rays
  double time = 0;             ///< T at (Q, k), in the unit of the costs
  std::int64_t looked_at = 0;  ///< spheres that a search over Q evaluated, one by one, to find it
};

inline constexpr std::int64_t most_looked_at = 16'000;

/// A good ratio in little time: the best of eight fixed ones, each with its best stop.
///
/// Accuracy   T above that of best_ratio_and_stop by 1.1 % in the median, 5 % at the 90th percentile, 14 % at worst
/// (300
///            random workloads: n_R, n_P 10² … 10⁸, d/r₀ 10⁻⁴ … 0.1, D 2 … 3, copies 0 … 2 t, rebuilds 0 … 50 t). One
///            ratio alone, optimal_ratio's, is 16 % above in the median, 95 % at worst.
/// Cost       about 30 µs, 4 µs a ratio.   Throws  as best_ratio_and_stop.
[[nodiscard]] BestRatio good_ratio_and_stop(const Workload& workload, const UnitCosts& costs);

/// Minimises T over 0.02 <= Q <= 0.98 and k = 1 … most_spheres with r_k >= d together.
///
/// Accuracy   Against the least on 20 000 ratios and more, the steps of k, and ever finer grids around all its minima,
///            on 750 random workloads: T within 6e-11 of it. No bound below T is proved: how steeply T may fall is
///            taken from what was seen.
/// Cost       4000 spheres in the mean, at 0.4 … 0.8 µs each; with most_spheres <= 40 at most most_looked_at.
/// Throws     std::invalid_argument for a workload or costs out of range.
[[nodiscard]] BestRatio best_ratio_and_stop(const Workload& workload, const UnitCosts& costs,
                                            std::int64_t most_spheres = 40);

/// The fastest stop k for a given Q, at least 1 (where a sphere holds a disc) and at most 4096.
[[nodiscard]] BestRatio best_stop(const Workload& workload, const UnitCosts& costs, RadiusRatio ratio);

/// The fastest Q for a given k, 0 … 9e18. Where no Q of the range has r_k >= d, the largest one.
[[nodiscard]] BestRatio best_ratio_for(const Workload& workload, const UnitCosts& costs, std::int64_t spheres);

/// The paper's advice: 0.6 to 0.7; its middle.
inline constexpr double published_ratio = 0.65;

}  // namespace detp::model
