#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

/// Orders of growth: how the time of a technique at its best parameters grows with the number of samples,
///
///     T = Θ(n_R n_P^p (log n_P)^q)
///
/// Two terms are not included, because they do not depend on n_R: sorting the samples, Θ(n_P log n_P), which the paper
/// omits, and building an index.
namespace detp::model {

struct Growth {
  double power = 0;    ///< p
  int logarithms = 0;  ///< q

  bool operator==(const Growth&) const = default;
};

/// How the disc radius changes when samples are added to the same scene.
enum class DiscRule {
  fixed,              ///< d is constant: each disc keeps its number of hits, so every technique takes at least n_R n_P
  as_sample_distance  ///< d ∝ n_P^{-1/D}
};

struct GrowthCase {
  Technique technique = Technique::brute_force;
  DiscRule disc = DiscRule::as_sample_distance;
  double dimension = 3;                       ///< D of the samples, 2 … 3
  SampleOrder order = SampleOrder::lebesgue;  ///< of the sphere cache; if unsorted, each sample rebuilds all spheres
  Form form = Form::corrected;
};

/// (p, q), with the best Q and the best cell sizes for each n_P.
///
///                            d fixed   d ∝ n_P^{-1/D}, published       corrected
///     brute force            1         1                               1
///     spheres, unsorted      1         1                               1
///     spheres, sorted        1         1/3       (eq 19)               1 - 2/D;  q = 1 for D = 2
///     octree                 1         1 - 2/D;  q = 1  (eq 22)        1 - 2/D;  q = 1 for D = 2
///     grid (balanced tree)   1         1 - 2/D   (section 4)           1/3
///
/// The paper states its orders for D = 3, where 1 - 2/D is 1/3. For other D, the published column follows from the
/// paper's formulas.
///
/// Source     our derivation. A sphere or node of size r meets a share r² of the lines; r^{-D} spheres or nodes of this
///            size hold samples. So T ∝ Σ r^{2-D}, over sizes r in geometric sequence down to d. For D > 2 the last
///            term dominates, d^{2-D} = n_P^{1-2/D}; for D = 2 all log n_P terms are equal. The disc tests, n_P d², are
///            of the order of the last term. So an octree has no factor log n_P in volumes. Spheres on surfaces have a
///            factor log n_P instead of n_P^{1/3} (the published m_i = Q^{-3i} is for volumes). A grid steps through
///            its empty cells: a^{-1} steps plus n_P a² tests, for cells of side a >= d, are smallest at
///            a ∝ n_P^{-1/3}.
/// Conditions isotropic unbounded lines; samples even over their volume or surface; r₀ fixed. If d is fixed, n_P d^D
///            far above 1. The factor log n_P is for a fixed Q or fan-out: then the number of spheres k or the depth of
///            the tree grows as log n_P (eq 18 and section 4.2). k → ln(r₀/d)/(1 - Q) as Q → 1: a simple pole. (The
///            paper: "exponentially".)
/// Fitted     to the best T of each technique over four decades of n_P from 10⁸, D = 2 and 3 (spheres also 2.5):
///            p is within 0.012 of the table, published within 0.001 (tests/model/optimum/growth.test.cpp). For cell
///            spheres and sphere trees only the derivation supports the orders.
/// Throws     std::invalid_argument unless 2 <= D <= 3, and for a technique without a closed form.
[[nodiscard]] Growth growth(const GrowthCase& growth_case);

}  // namespace detp::model
