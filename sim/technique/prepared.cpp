#include "prepared.hpp"

namespace detp::sim {

std::unique_ptr<Prepared> prepare(const Problem& problem, const Candidate& candidate, const RunOptions& options) {
  check(candidate);
  switch (candidate.technique) {
    case Technique::octree:
      return prepare_octree(problem, std::get<OctreeParameters>(candidate.parameters), options.stop);
    case Technique::grid:
      return prepare_grid(problem, std::get<GridParameters>(candidate.parameters), options.stop);
    case Technique::bvh:
      return prepare_bvh(problem, std::get<BvhParameters>(candidate.parameters), options.threads, options.stop);
    case Technique::bsp:
      return prepare_bsp(problem, std::get<BspParameters>(candidate.parameters), options.stop);
    default:
      return nullptr;
  }
}

}  // namespace detp::sim
