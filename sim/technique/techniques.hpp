#pragma once

#include <string_view>

#include "detp/sim/stopwatch.hpp"
#include "technique.hpp"

/// The techniques behind `run`. Each fills in an outcome; its parameters have been checked. One that is stopped before
/// it searches (while it sorts or builds) throws Stopped.
namespace detp::sim {

/// Throws std::invalid_argument for options that no technique can run with.
void check_options(const RunOptions& options, const Problem& problem);

/// Whether so many bytes fit the memory beside the problem's rays and discs.
[[nodiscard]] bool fits_memory(double bytes, const Problem& problem);

/// Throws std::length_error where they do not.
void require_memory_for(std::string_view what, double bytes, const Problem& problem);

/// The same, and enters into the outcome that the run takes so many bytes, and half a MiB for all that is small.
void need_memory(std::string_view what, double bytes, const Problem& problem, Outcome& outcome);

/// Bytes of a run's own totals, hits and irradiance; none where its totals are another's.
[[nodiscard]] double found_bytes(const Problem& problem, const RunOptions& options);

/// The outcome of a run that was stopped before it searched.
void give_nothing(const Problem& problem, const RunOptions& options, Outcome& outcome);

/// Every disc against every ray.
void run_brute_force(const Problem& problem, const RunOptions& options, Outcome& outcome);

/// Nested spheres with their rays, walked from the outermost inwards: nothing is lost.
///
/// A sphere serves a disc if the disc lies in it and in every larger one. From the first that does not hold the disc,
/// all are rebuilt around the disc's centre, each from the list of the one around it, as long as they hold the disc.
void run_sphere_cache(const Problem& problem, const SphereCacheParameters& parameters, const RunOptions& options,
                      Outcome& outcome);

/// The paper's walk (section 2.2), kept for study: it asks from the innermost sphere outwards for the first that holds
/// the disc. That sphere's list may lack rays, for it need not lie inside the larger ones: hits are lost.
void run_sphere_cache_published(const Problem& problem, const SphereCacheParameters& parameters,
                                const RunOptions& options, Outcome& outcome);

/// Spheres anchored to the cells of an octree (CellWalk), each built once along the Lebesgue curve from the list of the
/// one around it; the innermost's is tested.
void run_cell_spheres(const Problem& problem, const CellSpheresParameters& parameters, const RunOptions& options,
                      Outcome& outcome);

/// A tree of nested spheres over runs of discs along the Lebesgue curve (SphereTree): the list of rays is culled down
/// the tree, depth first, and tested against the leaves' discs. One list a level. With boxes it is
/// stream::search_boxes, but for a plain run.
void run_sphere_tree(const Problem& problem, const SphereTreeParameters& parameters, const RunOptions& options,
                     Outcome& outcome);

/// Octree over the discs: all leaves at one depth, empty nodes left out.
void run_octree(const Problem& problem, const OctreeParameters& parameters, const RunOptions& options,
                Outcome& outcome);

/// Uniform grid of cubic cells over the discs, walked cell by cell.
void run_grid(const Problem& problem, const GridParameters& parameters, const RunOptions& options, Outcome& outcome);

/// Bounding volume hierarchy over the discs by Embree. It shows the discs whose box a ray meets (and others of the same
/// leaf where discs are few); each is a disc test in double precision. None is missed: sim/README.md, "The culls".
/// Embree does not tell of the nodes it visits. It advises to flush tiny numbers to zero; the decision's doubles are
/// left as they are.
///
/// Boxes are a user geometry, whose callback decides. Beside them Embree's own points of inflated radius, with the same
/// decision in a filter (build + search, ms of processor time; tests a hit; one thread, the least of 11 runs):
///
///                                @uniform, 100 000 discs, 50 000 lines    @tree, 85 967 discs, 100 000 paths
///     boxes, low quality         11 + 103; 2.3                            9 + 93; 3.0
///     boxes, medium quality      44 + 97;  2.3                            34 + 87; 3.0
///     oriented discs             33 + 89;  1.0                            29 + 94; 2.0     loses grazing rays
///     discs facing the ray       32 + 124; 2.0                            28 + 108; 3.4
///     spheres                    33 + 140; 4.0                            28 + 129; 6.4    each disc told twice
///
/// Points get the same tree at low quality as at medium. Low quality is the default: with 10³ … 3·10⁵ rays on four
/// scenes it took 0.3 to 1.1 times what medium did. Throws std::runtime_error where Embree fails.
void run_bvh(const Problem& problem, const BvhParameters& parameters, const RunOptions& options, Outcome& outcome);

/// Another estimator, for comparison: the irradiance at a disc's centre from the k nearest photons, wherever they came
/// from. A photon is the end of a ray with a length; lines have none.
///
///     E = (power of the k - 1 nearest) / (π r_k²)        r_k: distance of the k-th nearest
///
/// Not k: that would be k/(k - 1) times too much where photons fall evenly (García, Ureña, Sbert, CGF 2012; its spread
/// and bias: model/nearest_photons.hpp). The discs' radii and normals do not matter, except that with front_facing only
/// photons count that arrive in front; a disc that fewer than k of them reach has irradiance 0.
///
/// Hits and pairs are the k - 1 photons used; counted are the photons stored (references) and these hits. On one
/// thread. Throws std::invalid_argument where no ray has a length, where there are fewer than k photons or k of them in
/// the very place of a disc's centre, and for totals to go on with, which nearest photons do not have.
void run_photon_map(const Problem& problem, const PhotonMapParameters& parameters, const RunOptions& options,
                    Outcome& outcome);
/// Axis-aligned BSP tree over the discs (BspNodes), empty leaves kept: rays go through it front to back, each with the
/// stretch of it that is in the node.
void run_bsp(const Problem& problem, const BspParameters& parameters, const RunOptions& options, Outcome& outcome);

}  // namespace detp::sim
