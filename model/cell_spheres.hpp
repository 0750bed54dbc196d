#pragma once

#include "vocabulary.hpp"

/// Spheres anchored to the cells of an octree: a cache whose costs are known exactly.
///
/// S_i belongs to the cell of side s_i = s/2^i that holds the sample: its centre is the cell's, its radius
/// r_i = s_i√3/2 + d, so that it holds the discs of all samples in the cell.
///
/// Nested. The child cell's centre lies s_{i+1}√3/2 from its parent's: half the child's diagonal. The radii differ by
/// r_i - r_{i+1} = (s_i - s_{i+1})√3/2 = s_{i+1}√3/2, just as much. Hence S_{i+1} ⊂ S_i, touching it from inside: a
/// list made from the parent's lacks no ray, and holds n_i = n_R (r_i/r₀)² of them, exactly as for spheres in S₀.
///
/// Built once. Along the Lebesgue curve all samples of a cell are visited one after another: a cell that holds a sample
/// is built once, whatever comes before. No law of first exits, no ratio to tune, nothing lost.
namespace detp::model {

/// r_i = s/2^i √3/2 + d.
[[nodiscard]] double cell_sphere_radius(const Workload& workload, int level);

/// Expected non-empty cells at a level, samples uniform in the cube: 8^i (1 - (1 - 8^{-i})^{n_P}).
///
/// Accuracy   4 ulp (expm1, log1p).   Throws  std::invalid_argument unless 0 <= level <= 300.
[[nodiscard]] double occupied_cell_spheres(double samples, int level);

/// Expected counts with spheres at the levels 1 … `levels` of the cube, lines of μ_ℓ through S₀: each sphere is built
/// once, from its parent's list, and each disc is tested against the innermost.
///
///     T_R = t Σ_{i=1..k} m_i n_{i-1},  n_0 = n_R      T_I = u n_P n_k
///
/// Source     our derivation.   Valid  samples uniform in the cube; r₀ of the workload at least that of its cube's
/// sphere.
[[nodiscard]] Counts<double> cell_sphere_counts(const Workload& workload, int levels);

}  // namespace detp::model
