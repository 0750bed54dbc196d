#pragma once

#include "index.hpp"

/// What prepares the search of each technique. Parameters have been checked and are the technique's own.
namespace detp::sim {

using Prepare = std::unique_ptr<Index>(const Problem& problem, const Parameters& parameters, const RunOptions& options);

Prepare prepare_brute_force, prepare_sphere_cache, prepare_sphere_cache_published, prepare_cell_spheres,
    prepare_sphere_tree, prepare_box_tree, prepare_octree, prepare_grid, prepare_bsp, prepare_bvh, prepare_photon_map;

struct TechniqueSearch {
  Technique technique;
  Prepare* prepare;
};

[[nodiscard]] const TechniqueSearch& search_of(Technique technique);

}  // namespace detp::sim
