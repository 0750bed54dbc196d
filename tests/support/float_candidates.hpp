#pragma once

#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::support {

/// Techniques that have a simd engine.
inline const std::vector<Candidate>& float_candidates() {
  static const std::vector<Candidate> list{{Technique::brute_force, BruteForceParameters{}},
                                           {Technique::sphere_cache, SphereCacheParameters{0.65, 8}},
                                           {Technique::sphere_cache, SphereCacheParameters{0.9, 1000}},
                                           {Technique::cell_spheres, CellSpheresParameters{2}},
                                           {Technique::cell_spheres, CellSpheresParameters{6}},
                                           {Technique::box_tree, BoxTreeParameters{2, 1}},
                                           {Technique::box_tree, BoxTreeParameters{8, 8}},
                                           {Technique::box_tree, BoxTreeParameters{4, 64}},
                                           {Technique::octree, OctreeParameters{1}},
                                           {Technique::octree, OctreeParameters{4, Traversal::neighbour_links}},
                                           {Technique::grid, GridParameters{1}},
                                           {Technique::grid, GridParameters{9}},
                                           {Technique::bsp, BspParameters{8}}};
  return list;
}

}  // namespace detp::support
