#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

/// Spheres anchored to the cells of an octree: a cache whose costs are known exactly.
///
/// S_i belongs to the cell of side s_i = s/2^i that holds the sample: its centre is the cell's, its radius
/// r_i = s_i√3/2 + d, so that it holds the discs of all samples in the cell.
///
/// Nested. The child cell's centre lies s_{i+1}√3/2 from its parent's: half the child's diagonal. The radii differ by
/// r_i - r_{i+1} = (s_i - s_{i+1})√3/2 = s_{i+1}√3/2, just as much. Hence S_{i+1} ⊂ S_i, touching it from inside: a
/// list made from the parent's lacks no ray, and holds n_i = n_R (r_i/r₀)² of them, exactly as for spheres in S₀.
/// (Lists lack no ray whether or not spheres are nested, as long as each holds all discs of its cell: a ray that hits
/// such a disc crosses all spheres around it. Nesting is what makes n_i exact.)
///
/// Inside S₀. In a cube S_0 of the walk is S₀ itself, r_0 = s√3/2 + d, and all others lie in it. In a flat box cells
/// are cubes on its longest side, which poke out of S₀: there n_i is an upper bound.
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

/// m_i: expected cells of a level that hold a sample.
///
///     m_i = Σ_cells 1 - (1 - p)^{n_P}
///
///   where  p   share of the samples in the cell
///
/// Samples uniform in the box, no extent given: p = cell's part of the box over the box: the formula above, in a cube.
/// On the box's faces (D = 2): p = its part of the faces over all of them: in a cube the cells at a face, at two and at
/// three have 1, 2 and 3 times 4^{-i}/6. Box sides that are no whole number of cells end in a cut one. Between D = 2
/// and D = 3 the geometric interpolation of both.
///
/// Samples of an extent of their own, volume V or area A: as many equal cells as they reach, V/s_i³ or (a random plane
/// crosses cells so often) 1.5 A/s_i², but no more than 8^i.
///
/// Source     our derivation.   Accuracy  1e-14 in a cube and on its faces; own extents: an estimate.
/// Throws     std::invalid_argument unless 0 <= level <= 300.
[[nodiscard]] double occupied_cell_spheres(const Workload& workload, int level);

/// n_i: n_R times crossing_probability of S_i, n_R (r_i/r₀)² for lines.
[[nodiscard]] double rays_in_cell_sphere(const Workload& workload, int level);

/// Expected counts with spheres at the levels 1 … depth of the cube, rays of the workload: each sphere is built once,
/// from its parent's list, and each disc is tested against the innermost.
///
///     T_R = t Σ_{i=1..k} m_i n_{i-1},  n_0 = n_R      T_I = u n_P n_k
///
/// Source     our derivation.   Valid  samples uniform in the cube or on its faces, S₀ around it, lines: exact.
[[nodiscard]] Counts<double> cell_sphere_counts(const Workload& workload, const CellSpheresParameters& parameters);

}  // namespace detp::model
