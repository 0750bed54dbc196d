#pragma once

#include <array>

#include "detp/model/vocabulary/parameters.hpp"

/// The number of cubic cells that an isotropic disc overlaps.
///
/// Notation: d is the disc's radius, a the cell's side, x = d/a; the disc extends h_i = d √(1 - n_i²) from its centre
/// along axis i (its reach).
namespace detp::model {

/// Mean product of the reaches along two axes, divided by d²: E[√((1 - n₁²)(1 - n₂²))], n uniform over the unit sphere.
/// Along one axis it is π/4. Both constants by 160-point Gauss rules.
inline constexpr double mean_reach_product_2 = 0.5932132264;
/// Mean product of the reaches along all three axes, divided by d³.
inline constexpr double mean_reach_product_3 = 0.4218115748;

/// One axis of an index: cells from 0 in steps of a, and discs whose centres lie from d to d + room. The last cell may
/// extend beyond 2d + room; no disc does.
struct IndexAxis {
  double cells = 1;
  double side = 1;  ///< a, length
  double room = 0;  ///< length
  double disc = 0;  ///< d, length
};

/// Where the centres are along an axis.
enum class Centres {
  uniform,   ///< anywhere in the room
  low_face,  ///< at the room's low end, like samples on a face of their box
  high_face
};

/// The expected number of planes of an axis that cross the disc, and the weights of the lines and corners in which
/// these planes meet those of other axes. Below, N is `planes`, L is `line_weight`, C is `corner_weight`.
///
///     E = 1 + Σ N_i + L_i (N_j + N_k) + c₂ N_j N_k + C_i N_j N_k
///
///   where  i        the axis along which the centres may be fixed; along j and k they are uniform
///          c₂       L/N of uniform centres
///          exact    N = Σ_p √(1 - u²), L = Σ_p (8/π²) [E(k) - u² K(k)], C = 0
///          boxes    N the same, L = Σ_p (8/π²) ∫₀^k E(√(1 - z²)) dz, C = Σ_p (16/π²) ∫₀^k B(z) dz
///          u, k     u = |p - c|/d <= 1 for plane p and centre c; k = √(1 - u²)
///          E, K     complete elliptic integrals;   B   mean of √((1 - n₂²)(1 - n₃²)) for n₁ = z
///
/// Source     our derivation. h > u d with probability √(1 - u²). A line of the grid at the distance ρ d from the
///            centre pierces the disc with probability (2/π) acos ρ; L is the integral of this along the plane.
/// Limits     uniform centres in endless cells: N = (π/2) x; L/N = 2/π (exact), 0.9616 (boxes); C/N = 0.8706.
struct PlaneCrossings {
  double planes = 0;
  double line_weight = 0;
  double corner_weight = 0;

  PlaneCrossings& operator+=(const PlaneCrossings& other);
  friend PlaneCrossings operator*(double factor, const PlaneCrossings& crossings) {
    return {factor * crossings.planes, factor * crossings.line_weight, factor * crossings.corner_weight};
  }
};

/// Crossings if the centres are uniform along the axis. `planes` is the expected number of planes that cross the disc.
[[nodiscard]] PlaneCrossings uniform_crossings(double planes, Insertion insertion);

/// Crossings summed over the planes of the axis, without the planes at the index's ends, which cross no disc. Exact for
/// x <= 64, except that the weights of uniform centres are those of infinitely many cells. For x > 64, or more than
/// 10¹⁵ cells, all values are those of uniform centres and infinitely many cells, with at most cells - 1 planes.
[[nodiscard]] PlaneCrossings crossings(const IndexAxis& axis, Centres centres, Insertion insertion);

/// A run of neighbouring slabs of an axis. A slab is the space between neighbouring planes. The values hold for one
/// slab, as means over the run; they are indexed by `Centres`.
struct Slabs {
  double count = 0;
  std::array<double, 3> centred{};          ///< probability that the disc's centre lies in the slab
  std::array<double, 3> pierced{};          ///< share of the lines along the axis that pierce the disc inside the slab
  std::array<PlaneCrossings, 3> reached{};  ///< discs whose centre is outside the slab and that reach into it
};

/// The slabs of an axis: at most 5 runs at each end, and one between. (A line along the axis pierces a disc at most u d
/// beyond its centre with probability ½ + (4/π) [¾ u √(1 - u²) + ¼ asin u - ½ u² acos u]. For uniform centres and for
/// boxes, `pierced` equals `centred` instead.)
struct SlabRuns {
  std::array<Slabs, 11> runs{};
  std::size_t size = 0;
};
[[nodiscard]] SlabRuns slab_runs(const IndexAxis& axis, Insertion insertion);

}  // namespace detp::model
