#pragma once

#include "detp/sim/lists/simd/disc_tree.hpp"
#include "detp/sim/technique/technique.hpp"
#include "structural_registry.hpp"

/// Expected counts of a box tree, computed from its boxes without rays.
namespace detp::validate {

/// P, the share of the isotropic lines through S₀ that the cull of a box lists. The plain engine lists the lines that
/// cross the box, P = F/(4π r₀²). The simd engine (cull_box of sim/lists/simd/kernels-inl.hpp) lists these lines and
/// some that miss the box.
///
/// The simd engine lists a line of the class of axis z, x = p + a z and y = q + b z, with |a|, |b| <= 1, if
///
///     |p + a c_z - c_x| <= h_x + |a| h_z    and    |q + b c_z - c_y| <= h_y + |b| h_z
///
///   where  c   centre of the box,  h  half the sides of the box
///
/// For one direction (a, b), the listed lines cross a plane of constant z in a rectangle of the area
///
///     4 (h_x + |a| h_z)(h_y + |b| h_z)
///
/// This area times the cosine (1 + a² + b²)^{-1/2} is the area perpendicular to the lines. Integrating it over the
/// directions, dω = da db (1 + a² + b²)^{-3/2}, summing over the three classes, and dividing by the measure 2π · π r₀²
/// of the lines through S₀ gives
///
///     P = [F/4π + (2 ln(4/3)/π²) (h_x² + h_y² + h_z²)] / r₀²
///
///   where  F   surface of the box, 8 (h_x h_y + h_y h_z + h_z h_x)
///
/// Proof: let w = (1 + a² + b²)^{-2}. Over [-1, 1]², ∫∫w = 2√2 atan(1/√2), ∫∫|a|w = π/2 - √2 atan(1/√2) and
/// ∫∫|ab|w = ln(4/3). So the coefficients of h_x h_y of the three classes add up to π. The first term of P counts the
/// lines that cross the box, the second the listed lines that miss the box: 9 % more for a cube.
///
/// If some listed lines may miss S₀, P is multiplied by the share that crosses S₀, integrated over a fixed set of
/// lines.
///
/// Source     our derivation.
/// Accuracy   exact if all listed lines cross S₀; else the error of the share is at most 1 %.
class BoxCrossing {
 public:
  /// Lengths are in the frame's units. Each box is grown by `margin` on all sides.
  BoxCrossing(double outer_radius, double margin, Engine engine = Engine::simd);

  [[nodiscard]] double operator()(const sim::stream::TreeNode& box) const;

 private:
  double outer_;
  double margin_;
  Engine engine_;
};

}  // namespace detp::validate
