#pragma once

#include <vector>

#include "detp/model/vocabulary.hpp"

namespace detp::support {

/// Techniques that decide in floats what floats can decide; but for RunOptions::plain.
inline const std::vector<Candidate>& float_candidates() {
  static const std::vector<Candidate> list{{Technique::brute_force, BruteForceParameters{}},
                                           {Technique::sphere_cache, SphereCacheParameters{0.65, 8}},
                                           {Technique::sphere_cache, SphereCacheParameters{0.9, 1000}},
                                           {Technique::cell_spheres, CellSpheresParameters{2}},
                                           {Technique::cell_spheres, CellSpheresParameters{6}},
                                           {Technique::sphere_tree, SphereTreeParameters{2, 1, Bounds::boxes}},
                                           {Technique::sphere_tree, SphereTreeParameters{8, 8, Bounds::boxes}},
                                           {Technique::sphere_tree, SphereTreeParameters{4, 64, Bounds::boxes}}};
  return list;
}

}  // namespace detp::support
