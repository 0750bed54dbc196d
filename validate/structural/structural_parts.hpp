#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/model/vocabulary/ray_blocks.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/geometry/geometry.hpp"
#include "detp/sim/lists/simd/disc_tree.hpp"
#include "detp/sim/technique/technique.hpp"

/// Parts of structural counts: those of each technique, of a box, and of the sphere cache's walk.
namespace detp::validate {

/// Isotropic lines through S₀, and the engine that searches them.
struct Lines {
  double rays = 0;
  Engine engine = Engine::simd;

  [[nodiscard]] RayBlocks blocks(const sim::Problem& problem) const {
    return ray_blocks(rays, static_cast<double>(problem.discs().size()), engine);
  }
};

/// The expected counts of a search, without hits and loaded rays. A technique without such a function can only be run. The parameters are
/// checked. Throws as structural_counts.
template <class Own>
using CountsOf = Counts<double>(const sim::Problem& problem, const Lines& lines, const Own& parameters,
                                const std::stop_token& stop);
CountsOf<SphereCacheParameters> counts_of;
CountsOf<CellSpheresParameters> counts_of;
CountsOf<SphereTreeParameters> counts_of;
CountsOf<BoxTreeParameters> counts_of;
CountsOf<OctreeParameters> counts_of;
CountsOf<GridParameters> counts_of;
CountsOf<BspParameters> counts_of;

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

/// Of the sphere cache, computed from the samples alone. The samples determine when a sphere is
/// rebuilt. Integral geometry gives the expected number of rays in the list of a rebuilt sphere.
struct ExpectedSphere {
  double rebuilds = 0;  ///< exact: the technique rebuilds the sphere at the same samples
  double tests = 0;     ///< ray-sphere tests of all rebuilds of the sphere, per ray
  double listed = 0;    ///< rays listed by all rebuilds of the sphere, per ray
};

struct ExpectedWalk {
  std::vector<ExpectedSphere> spheres;  ///< S₁ … S_k
  double cull_tests = 0;                ///< T_R for t = 1, per ray
  double disc_tests = 0;                ///< T_I for u = 1, per ray
};

/// Walks the discs along the Morton curve as the sphere cache does, O(k n_P).
///
/// The expected share of the rays in the list of S_i is (r_i/r₀)² times the share of the lines through S_i that also
/// cross the spheres around S_i. At each rebuild the second share is estimated from 8 or 64 lines of a fixed pool,
/// moved so that they go through S_i. The lines are tested with the 32 next larger spheres only.
///
/// Valid      isotropic lines through S₀, all discs of one radius.
/// Accuracy   5000 samples in a cube and on its faces, d/r₀ = 0.011, Q 0.3 … 0.9, counts of 6 × 40 000 lines: T_R
///            within 0.35 %, T_I within 0.33 % (noise of the lines: 0.1 and 0.4 %). 20 000 samples of @tree, @cornell
///            and three meshes, Q 0.5 … 0.9, 4 × 10 000 lines: T_R within 2.1 %, T_I within 5 %. The largest deviation
///            (@tree) is noise: with 24 × 10 000 other lines, expected / counted T_R and T_I are 1.000 ± 0.004 and
///            1.008 ± 0.008.
/// Throws     sim::Stopped if a stop was requested.
[[nodiscard]] ExpectedWalk structural_walk(std::span<const sim::Disc> discs, const sim::Sphere& enclosing,
                                           const SphereCacheParameters& parameters, const std::stop_token& stop = {});

}  // namespace detp::validate
