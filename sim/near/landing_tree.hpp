#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <nanoflann.hpp>
#include <vector>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/search/problem.hpp"

/// The places where photons met a surface, in a kd-tree.
namespace detp::sim {

struct Landing {
  glm::dvec3 place;
  std::uint32_t ray;
};

/// Of all rays whose photon met a surface (Problem::landing), in the order of the rays.
[[nodiscard]] inline std::vector<Landing> landings_of(const Problem& problem, StopCheck& check) {
  std::vector<Landing> landings;
  landings.reserve(problem.rays().size());
  for (std::uint32_t number = 0; number < problem.rays().size(); ++number) {
    const Ray& ray = problem.rays()[number];
    if (const double landing = problem.landing(number); landing < unbounded)
      landings.push_back({ray.origin + landing * ray.direction, number});
    check.after(1);
  }
  return landings;
}

/// The landings in the form that nanoflann requires. Building a tree calls these functions for every landing, so they
/// also check for a stop request, and throw Stopped.
struct LandingCloud {
  std::vector<Landing> landings;
  StopCheck* building;  ///< null once the tree is built

  [[nodiscard]] std::size_t kdtree_get_point_count() const { return landings.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t landing, std::size_t axis) const {
    if (building != nullptr) building->after(1);
    return landings[landing].place[static_cast<int>(axis)];
  }
  template <class BoundingBox>
  bool kdtree_get_bbox(BoundingBox&) const {
    return false;
  }
};

using LandingKdTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, LandingCloud>,
                                                          LandingCloud, 3, std::uint32_t>;

/// Bytes of the landings, of the indices by which nanoflann's tree orders them, and of the tree's nodes. A leaf holds at most
/// 10 landings. On average it holds 5 to 6 if repeated halving splits evenly spread landings, and fewer if they are
/// concentrated.
[[nodiscard]] inline double landing_tree_bytes(const Problem& problem) {
  constexpr double in_a_leaf = 5.5;
  constexpr double node = sizeof(LandingKdTree::Node);
  double landings = 0;
  for (std::size_t ray = 0; ray < problem.rays().size(); ++ray) landings += problem.landing(ray) < unbounded ? 1 : 0;
  return landings * (sizeof(Landing) + sizeof(std::uint32_t) + 2 * node / in_a_leaf);
}

}  // namespace detp::sim
