#pragma once

#include <array>

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::model {

/// The leaves that a search tries: 4, 8 … 256.
inline constexpr std::array searched_leaves{4, 8, 16, 32, 64, 128, 256};

/// A rough estimate of the time with each of searched_leaves, minus the time with the largest: only to decide which
/// leaves to evaluate.
///
/// Trees with leaves of L and 2L discs differ in the nodes of L < m <= 2L discs whose parent has more than 2L. With L
/// they are split:
///
///     leaf    n_R P m u + B(P) m l
///     split   n_R (7/6 P' t + 2 P_h m/2 u + (2 P_h - 5/6 P) c) + 7/6 B(P') r + B(P_h) m l + 2 g
///
///   where  P, P_h, P'   share of the rays in the list of the node, its half, and the top of its wide node (P²/P_h)
///          B(P)         blocks of rays with a ray in that list;   t, u, l, c, r, g   unit costs
///
/// for a fan-out of 8. Terms of lists also count the halves that are split again. Nodes that the surface-area heuristic
/// turns into leaves anyway are left out. All cells of a level count as equal, with m normal and P at the mean m; on
/// surfaces all as cells of one face.
///
/// Source     our derivation.
[[nodiscard]] std::array<double, searched_leaves.size()> rough_leaf_costs(const Valid<Workload>& workload,
                                                                          const Valid<UnitCosts>& costs, Engine engine);

}  // namespace detp::model
