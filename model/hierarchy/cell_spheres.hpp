#pragma once

#include <functional>

#include "detp/model/vocabulary/vocabulary.hpp"

/// Spheres anchored to the cells of an octree: a cache whose costs are known exactly.
///
/// S_i belongs to the cell of side s_i = s/2^i that holds the current sample. Its centre is the cell's; its
/// radius is r_i = s_i√3/2 + d, so it contains the discs of all samples in the cell.
///
/// Nested: the centres of a cell and of its child are s_{i+1}√3/2 apart, half the child's diagonal. The radii differ by
/// the same length: r_i - r_{i+1} = (s_i - s_{i+1})√3/2 = s_{i+1}√3/2. So S_{i+1} lies in S_i and touches it from
/// inside. A list culled from the parent's list loses no ray, and holds exactly n_i = n_R (r_i/r₀)² rays if S_i lies in
/// S₀.
///
/// Inside S₀: if the samples' box is a cube, the sphere of the root cell is S₀ itself, r₀ = s√3/2 + d, and all others
/// lie in S₀. If the box is flat, the cells are those of a cube on its longest side, and spheres extend outside S₀;
/// then n_i is an upper bound.
///
/// Built once: along the Morton curve all samples of a cell are visited consecutively, so the sphere of a cell that
/// holds a sample is built exactly once. There is no law of rebuilds, and no ratio to tune.
namespace detp::model {

/// r_i = s/2^i √3/2 + d.
[[nodiscard]] double cell_sphere_radius(const Valid<Workload>& workload, int level);

/// Expected number of non-empty cells at level i, for samples uniform in the cube: 8^i (1 - (1 - 8^{-i})^{n_P}).
///
/// Accuracy   4 ulp (expm1, log1p).
/// Throws     std::invalid_argument unless n_P is a whole number 1 … 1e18 and 0 <= level <= 300.
[[nodiscard]] double occupied_cell_spheres(double samples, int level);

/// m_i: expected number of cells of level i that hold a sample.
///
///     m_i = Σ_cells 1 - (1 - p)^{n_P}
///
///   where  p   share of the samples in the cell
///
/// If Workload::sample_extent is 0, for D = 3 p is the share of the box's volume in the cell; in a cube this is the
/// formula above. For D = 2 p is the share of the area of the box's faces in the cell; in a cube the cells at one, two
/// and three faces have p = 1, 2 and 3 times 4^{-i}/6. If a side of the box is not a whole number of cells, the last
/// cell is cut. For D between 2 and 3: the geometric interpolation of both.
///
/// If Workload::sample_extent is a volume V or an area A, the sum is over V/s_i³ or 1.5 A/s_i² equal cells (as many as
/// a random surface of area A crosses), at least 1 and at most 8^i.
///
/// Source     our derivation.
/// Accuracy   1e-14 in a cube and on its faces; with sample_extent: an estimate.
/// Throws     std::invalid_argument unless 0 <= level <= 300.
[[nodiscard]] double occupied_cell_spheres(const Valid<Workload>& workload, int level);

/// n_i: n_R times crossing_probability of S_i, n_R (r_i/r₀)² for lines.
[[nodiscard]] double rays_in_cell_sphere(const Valid<Workload>& workload, int level);

/// Expected counts with spheres at levels 1 … k, k = depth. Each sphere's list is culled once from its parent's list.
/// Each disc is tested against the list of the innermost sphere.
///
///     T_R = t Σ_{i=1..k} m_i n_{i-1},  n_0 = n_R      T_I = u n_P n_k
///
/// Source     our derivation.
/// Valid      exact for samples uniform in the cube or on its faces, S₀ around it, and lines.
[[nodiscard]] Counts<double> cell_sphere_counts(const Valid<Workload>& workload,
                                                const Valid<CellSpheresParameters>& parameters);

/// Calls visit with these counts for k = 0, 1 … deepest, until visit returns false. Evaluates each level once.
void for_each_cell_sphere_depth(const Valid<Workload>& workload, const Valid<CellSpheresParameters>& deepest,
                                const std::function<bool(const Counts<double>&)>& visit);

}  // namespace detp::model
