#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

/// Spheres anchored to the cells of an octree: a cache whose costs are known exactly.
///
/// S_i belongs to the cell of side s_i = s/2^i that holds the sample. Its centre is the cell's; its radius is
/// r_i = s_i√3/2 + d, so it contains the discs of all samples in the cell.
///
/// Nested: the child cell's centre is s_{i+1}√3/2, half the child's diagonal, away from its parent's. The radii differ
/// by r_i - r_{i+1} = (s_i - s_{i+1})√3/2 = s_{i+1}√3/2, which is the same. So S_{i+1} ⊂ S_i, touching it from inside:
/// a list culled from the parent's loses no ray, and holds n_i = n_R (r_i/r₀)² rays, exactly as for spheres in S₀. (A
/// list loses no ray even if the spheres are not nested, as long as each contains all discs of its cell, because a ray
/// that hits such a disc crosses all spheres around it. Only because of the nesting is n_i exact.)
///
/// Inside S₀: in a cube S_0 of the walk is S₀ itself, r_0 = s√3/2 + d, and all others lie in it. In a flat box the
/// cells are those of a cube on its longest side, and spheres extend outside S₀; then n_i is an upper bound.
///
/// Built once: along the Morton curve all samples of a cell are visited consecutively, so a cell that holds a sample is
/// built exactly once. There is no law of rebuilds, no ratio to tune, and no ray is lost.
namespace detp::model {

/// r_i = s/2^i √3/2 + d.
[[nodiscard]] double cell_sphere_radius(const Valid<Workload>& workload, int level);

/// Expected non-empty cells at a level, samples uniform in the cube: 8^i (1 - (1 - 8^{-i})^{n_P}).
///
/// Accuracy   4 ulp (expm1, log1p).   Throws  std::invalid_argument unless 0 <= level <= 300.
[[nodiscard]] double occupied_cell_spheres(double samples, int level);

/// m_i: expected cells of a level that hold a sample.
///
///     m_i = Σ_cells 1 - (1 - p)^{n_P}
///
///   where  p   share of the samples in the cell
///
/// Samples uniform in the box, without an extent of their own: p is the cell's part of the box divided by the box; in a
/// cube this is the formula above. On the box's faces (D = 2): p is the cell's part of the faces divided by all faces;
/// in a cube the cells at one, two and three faces have 1, 2 and 3 times 4^{-i}/6. If a box side is not a whole number
/// of cells, the last cell is cut. For D between 2 and 3: the geometric interpolation of both.
///
/// Samples with an extent of their own, volume V or area A: as many equal cells as it covers, V/s_i³ or (as often as a
/// random plane crosses cells) 1.5 A/s_i², but at most 8^i.
///
/// Source     our derivation.
/// Accuracy   1e-14 in a cube and on its faces; with an extent of their own: an estimate.
/// Throws     std::invalid_argument unless 0 <= level <= 300.
[[nodiscard]] double occupied_cell_spheres(const Valid<Workload>& workload, int level);

/// n_i: n_R times crossing_probability of S_i, n_R (r_i/r₀)² for lines.
[[nodiscard]] double rays_in_cell_sphere(const Valid<Workload>& workload, int level);

/// Expected counts with spheres at the levels 1 … depth of the cube. Each sphere is built once, from its parent's list,
/// and each disc is tested against the innermost.
///
///     T_R = t Σ_{i=1..k} m_i n_{i-1},  n_0 = n_R      T_I = u n_P n_k
///
/// Source     our derivation.
/// Valid      exact for samples uniform in the cube or on its faces, S₀ around it, and lines.
[[nodiscard]] Counts<double> cell_sphere_counts(const Valid<Workload>& workload,
                                                const Valid<CellSpheresParameters>& parameters);

}  // namespace detp::model
