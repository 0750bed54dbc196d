#pragma once

#include <cstdint>

#include "form.hpp"
#include "vocabulary.hpp"

/// The radius ratio Q at which the sphere cache is fastest.
///
/// T(Q) jumps where another sphere fits, at Q_j = (d/r₀)^{1/j}. Between two jumps it is smooth: each piece is minimised
/// by Brent's method around the best of a few points, and its ends are tried too, for the minimum often lies at a Q_j.
namespace detp::model {

struct BestRatio {
  double ratio = 0;          ///< Q
  std::int64_t spheres = 0;  ///< k
  double time = 0;           ///< T at (Q, k), in the unit of the costs
};

/// Minimises T over Q with k as `sphere_count` gives it (published: ⌈·⌉ and the paper's T; corrected: ⌊·⌋ and ours),
/// over the pieces with k = 1 … most_spheres.
///
/// Accuracy   of Q 1e-6; of T 1e-9 within each piece where it has one minimum.
/// Throws     std::invalid_argument for a workload out of range or d >= r₀: there is no sphere then.
[[nodiscard]] BestRatio best_ratio(Form form, const Workload& workload, const UnitCosts& costs,
                                   std::int64_t most_spheres = 40);

/// Minimises the corrected T over Q and k together: stopping at r_k of a few d often beats going down to d.
[[nodiscard]] BestRatio best_ratio_and_stop(const Workload& workload, const UnitCosts& costs,
                                            std::int64_t most_spheres = 40);

/// The fastest stop k for a given Q, and the fastest Q for a given k, by the corrected T.
[[nodiscard]] BestRatio best_stop(const Workload& workload, const UnitCosts& costs, RadiusRatio ratio);
[[nodiscard]] BestRatio best_ratio_for(const Workload& workload, const UnitCosts& costs, std::int64_t spheres);

/// The paper's advice: 0.6 to 0.7; its middle.
inline constexpr double published_ratio = 0.65;

}  // namespace detp::model
