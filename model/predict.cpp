#include "predict.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "box_tree.hpp"
#include "cell_spheres.hpp"
#include "disc_index.hpp"
#include "line_measure.hpp"
#include "rebuild_law.hpp"
#include "sphere_cache.hpp"
#include "sphere_cache_published.hpp"
#include "sphere_tree.hpp"

namespace detp::model {
namespace {

/// Plain density estimation on the tangent plane: each disc against each ray.
Counts<double> brute_force_counts(const Workload& workload) {
  return {.disc_tests = workload.rays * workload.samples, .hits = expected_hits(workload)};
}

}  // namespace

Counts<double> predict(const Workload& workload, const Candidate& candidate) {
  check(workload);
  check(candidate);
  switch (candidate.technique) {
    case Technique::brute_force:
      return brute_force_counts(workload);
    case Technique::sphere_cache:
      return sphere_cache_counts(workload, std::get<SphereCacheParameters>(candidate.parameters));
    case Technique::sphere_cache_published: {
      const auto& parameters = std::get<SphereCacheParameters>(candidate.parameters);
      require_rebuild_law(parameters.order);
      return published::counts(workload, {parameters.ratio}, parameters.spheres);
    }
    case Technique::cell_spheres:
      return cell_sphere_counts(workload, std::get<CellSpheresParameters>(candidate.parameters));
    case Technique::sphere_tree: {
      const auto& parameters = std::get<SphereTreeParameters>(candidate.parameters);
      return parameters.bounds == Bounds::boxes ? box_tree_counts(workload, parameters)
                                                : sphere_tree_counts(workload, parameters);
    }
    case Technique::octree:
      return octree_counts(workload, std::get<OctreeParameters>(candidate.parameters));
    case Technique::grid:
      return grid_counts(workload, std::get<GridParameters>(candidate.parameters));
    case Technique::bsp:
    case Technique::bvh:
    case Technique::photon_map:
      throw std::invalid_argument(
          fmt::format("there is no closed form of {}; it can only be run", name(candidate.technique)));
  }
  throw std::logic_error("a technique without a model");
}

}  // namespace detp::model
