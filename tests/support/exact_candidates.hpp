#pragma once

#include <vector>

#include "detp/model/vocabulary.hpp"

namespace detp::support {

/// Every exact technique, with few and with many parts, walked in each way it has.
inline const std::vector<Candidate>& exact_candidates() {
  static const std::vector<Candidate> list{
      {Technique::brute_force, BruteForceParameters{}},
      {Technique::sphere_cache, SphereCacheParameters{0.65, 8}},
      {Technique::sphere_cache, SphereCacheParameters{0.3, 3, SampleOrder::none}},
      {Technique::sphere_cache, SphereCacheParameters{0.9, 40, SampleOrder::hilbert}},
      {Technique::cell_spheres, CellSpheresParameters{3}},
      {Technique::sphere_tree, SphereTreeParameters{4, 2}},
      {Technique::sphere_tree, SphereTreeParameters{2, 1, Bounds::boxes}},
      {Technique::octree, OctreeParameters{2}},
      {Technique::octree, OctreeParameters{4, Traversal::front_to_back}},
      {Technique::octree, OctreeParameters{3, Traversal::restart}},
      {Technique::octree, OctreeParameters{3, Traversal::neighbour_links}},
      {Technique::grid, GridParameters{1}},
      {Technique::grid, GridParameters{7}},
      {Technique::bsp, BspParameters{12, 1}},
      {Technique::bvh, BvhParameters{BuildQuality::low}},
      {Technique::bvh, BvhParameters{BuildQuality::medium}}};
  return list;
}

}  // namespace detp::support
