#pragma once

#include <chrono>
#include <utility>

#include "technique.hpp"

/// The techniques behind `run`. Each fills in an outcome; its parameters have been checked.
namespace detp::sim {

/// Seconds since it was made or last read.
class Stopwatch {
 public:
  [[nodiscard]] double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(start_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Throws std::invalid_argument for options that no technique can run with.
void check_options(const RunOptions& options, const Problem& problem);

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
/// the tree, depth first, and tested against the leaves' discs. One list a level.
void run_sphere_tree(const Problem& problem, const SphereTreeParameters& parameters, const RunOptions& options,
                     Outcome& outcome);

/// Octree over the discs: all leaves at one depth, empty nodes left out, top-down traversal.
void run_octree(const Problem& problem, const OctreeParameters& parameters, const RunOptions& options,
                Outcome& outcome);

/// Uniform grid of cubic cells over the discs, walked cell by cell.
void run_grid(const Problem& problem, const GridParameters& parameters, const RunOptions& options, Outcome& outcome);

}  // namespace detp::sim
