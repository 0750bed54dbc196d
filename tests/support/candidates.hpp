#pragma once

#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

/// Techniques with parameters.
namespace detp::support {

/// Those that this build of the library has.
inline std::vector<Candidate> built(std::vector<Candidate> candidates) {
  std::erase_if(candidates, [](const Candidate& candidate) { return !record_of(candidate.technique).built; });
  return candidates;
}

/// Variants of every exact technique with small parameters.
inline const std::vector<Candidate>& exact_candidates() {
  static const std::vector<Candidate> list = [] {
    std::vector<Candidate> all;
    for (const TechniqueRecord& record : technique_records)
      if (record.exact && record.built)
        for (const Candidate& variant : small_variants(record.technique)) all.push_back(variant);
    return all;
  }();
  return list;
}

/// A variant of every exact technique, brute force first.
inline const std::vector<Candidate>& one_of_each() {
  static const std::vector<Candidate> list =
      built({{Technique::brute_force, BruteForceParameters{}},
             {Technique::sphere_cache, SphereCacheParameters{0.6, 4}},
             {Technique::cell_spheres, CellSpheresParameters{3}},
             {Technique::sphere_tree, SphereTreeParameters{8, 4}},
             {Technique::box_tree, BoxTreeParameters{8, 4}},
             {Technique::octree, OctreeParameters{3}},
             {Technique::octree, OctreeParameters{3, Traversal::neighbour_links}},
             {Technique::bsp, BspParameters{8, 4}},
             {Technique::bvh, BvhParameters{}},
             {Technique::ray_map, RayMapParameters{}},
             {Technique::grid, GridParameters{8}}});
  return list;
}

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
