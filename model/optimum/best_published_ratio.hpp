#pragma once

#include <cstdint>

#include "detp/model/vocabulary/vocabulary.hpp"

/// The radius ratio at which the paper's T = T_R + T_I is smallest, with a certified bound.
///
/// k = ⌈log_Q(d/r₀)⌉ is j on the interval (Q_{j-1}, Q_j], where Q_j = (d/r₀)^{1/j}. Each interval is also cut where
/// m_J = n_P for some sphere J, at Q = n_P^{-1/(3J)}. On each part, with x = ln Q,
///
///     T(x) = t n_R [ Σ_{i=1..J} e^{-(i+2)x} + n_P Σ_{i=J+1..j} e^{2(i-1)x} ] + u n_R n_P e^{2jx}
///
/// is a sum of exponentials with positive coefficients, so it is convex. Its tangent at any point is a lower bound over
/// the whole part, and where T' = 0 the bound is the minimum itself. Source: our derivation from eqs (8, 12, 17).
namespace detp::model::published {

struct BestRatio {
  double ratio = 0;          ///< Q
  std::int64_t spheres = 0;  ///< k
  double time = 0;           ///< T at (Q, k), in the unit of the costs
  double lower_bound = 0;    ///< T is not smaller at any Q searched, with k = 1 … most_spheres
};

/// Minimises the published T over 0.02 <= Q <= 0.98 with k = 1 … most_spheres.
///
/// Accuracy   lower_bound is within 1e-9 of time (relative). Cost: tens of microseconds; grows with most_spheres².
/// Limits     if no interval is in the range (d very close to r₀), spheres = 0.
/// Throws     std::invalid_argument for a workload out of range, and for d >= r₀ (no sphere).
[[nodiscard]] BestRatio best_ratio(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                   std::int64_t most_spheres = 40);

/// The number of spheres k at which the published T is smallest for a given Q, from 1 to the paper's own
/// k = ⌈log_Q(d/r₀)⌉; 0 if the latter is 0.
///
/// Adding sphere k pays off if t min(n_P, Q^{-3k}) < u n_P (1 - Q²). The left side grows with k, the right side does
/// not. So the result is the largest k that pays off. Source: our derivation from eqs (8, 12, 17).
///
/// Throws     as sphere_count does, and std::invalid_argument for a workload or costs out of range.
[[nodiscard]] std::int64_t best_stop(const Valid<Workload>& workload, const Valid<UnitCosts>& costs, RadiusRatio ratio);

}  // namespace detp::model::published
