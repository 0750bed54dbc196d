#pragma once

#include "detp/sim/lists/simd/disc_tree.hpp"
#include "detp/sim/technique/technique.hpp"
#include "structural_registry.hpp"

/// Expected counts of a box tree, computed from its boxes without rays.
namespace detp::validate {

/// Share of the isotropic lines through S₀ that the cull of a box lists. The plain engine lists the lines that cross the
/// box, P = F/(4π r₀²). The simd engine (cull_box of sim/lists/simd/kernels-inl.hpp) lists some more.
///
/// A line of the class of axis z, x = p + a z and y = q + b z, is listed by the simd engine if
///
///     |p + a c_z - c_x| <= h_x + |a| h_z    and    |q + b c_z - c_y| <= h_y + |b| h_z
///
/// For one direction these lines cross a plane of constant z in a parallelogram of the area
///
///     4 (h_x + |a| h_z)(h_y + |b| h_z)
///
/// Multiplied by the cosine (1 + a² + b²)^{-1/2} this is the area perpendicular to the lines. The directions are
/// integrated with dω = da db (1 + a² + b²)^{-3/2}. The result is summed over the three classes, and divided by the
/// measure 2π · π r₀² of the lines through S₀:
///
///     P = [F/4π + (2 ln(4/3)/π²) (h_x² + h_y² + h_z²)] / r₀²
///
///   where  F   surface of the box, 8 (h_x h_y + h_y h_z + h_z h_x)
///
/// Proof: with w = (1 + a² + b²)^{-2}, integrals over [-1, 1]² are ∫∫w = 2√2 atan(1/√2), ∫∫|a|w = π/2 - √2 atan(1/√2),
/// so that the coefficient of h_x h_y is π in all, and ∫∫|ab|w = ln(4/3). The first term counts the lines that cross
/// the box, the second the lines that are listed but miss the box: 9 % for a cube.
///
/// If listed lines could miss S₀, the share that does not is integrated over a fixed set of lines.
///
/// Source     our derivation.
/// Accuracy   exact inside S₀; elsewhere the error of the share is at most 1 %.
class BoxCrossing {
 public:
  /// Lengths are in the frame's units. Boxes are grown by the margin.
  BoxCrossing(double outer_radius, double margin, Engine engine = Engine::simd);

  [[nodiscard]] double operator()(const sim::stream::TreeNode& box) const;

 private:
  double outer_;
  double margin_;
  Engine engine_;
};

}  // namespace detp::validate
