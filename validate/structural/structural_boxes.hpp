#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/lists/simd/disc_tree.hpp"
#include "detp/sim/technique/technique.hpp"

/// What a tree of boxes says of its own search, before any ray.
namespace detp::validate {

/// Share of the isotropic lines through S₀ that the cull of a box lists (cull_box of sim/lists/simd/kernels-inl.hpp).
///
/// A line of the class of axis z, x = p + a z and y = q + b z, is listed if |p + a c_z - c_x| <= h_x + |a| h_z and the
/// same in y: of its direction a parallelogram whose area, in a plane of constant z, is 4 (h_x + |a| h_z)(h_y + |b|
/// h_z). Times the cosine (1 + a² + b²)^{-1/2} it is the area across; dω = da db (1 + a² + b²)^{-3/2}. Summed over the
/// three classes, and over the measure 2π · π r₀² of the lines through S₀,
///
///     P = [F/4π + (2 ln(4/3)/π²) (h_x² + h_y² + h_z²)] / r₀²
///
///   where  F   surface of the box, 8 (h_x h_y + h_y h_z + h_z h_x)
///
/// for over [-1, 1]², with w = (1 + a² + b²)^{-2}, ∫∫w = 2√2 atan(1/√2) and ∫∫|a|w = π/2 - √2 atan(1/√2), so that of
/// h_x h_y there is π in all, and ∫∫|ab|w = ln(4/3). The first term is that of lines that cross the box, the second of
/// those listed for nothing: 9 % in a cube.
///
/// Where lines that are listed could pass S₀, the share that does not is integrated over a fixed set of lines.
///
/// Source     our derivation.
/// Accuracy   exact in S₀; elsewhere the share is off by 1 % or less.
class BoxCrossing {
 public:
  /// Lengths are the frame's. Boxes grow by the margin.
  BoxCrossing(double outer_radius, double margin);

  [[nodiscard]] double operator()(const sim::stream::TreeNode& box) const;

 private:
  double outer_;
  double margin_;
};

/// Sums over the nodes of a tree of boxes except the root, which every ray is in.
struct BoxTreeCounts {
  double tests = 0;   ///< tests against boxes, per ray: Σ P(parent)
  double listed = 0;  ///< rays listed, per ray: Σ P(node)
  double discs = 0;   ///< tests against discs, per ray: Σ_leaves P(leaf) discs(leaf)
  double culls = 0;   ///< nodes tested at all, by all rays, in blocks of rays_in_block
  double visits = 0;  ///< discs tested at all, likewise
};

/// What `rays` isotropic lines do in the tree of boxes over the discs. As boxes are nested, so are the lists.
[[nodiscard]] BoxTreeCounts box_tree_counts(const sim::Problem& problem, double rays,
                                            const BoxTreeParameters& parameters, const std::stop_token& stop = {});

}  // namespace detp::validate
