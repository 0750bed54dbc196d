#include "piloted_discs.hpp"

#include <utility>

#include "box_tree.hpp"
#include "detp/sim/search/run_memory.hpp"

namespace detp::sim {

PilotedDiscs::PilotedDiscs(const Problem& problem, const stream::PilotRays& rays, std::size_t subtrees,
                           const RunOptions& options) {
  require_memory_for("the sorted discs", stream::building_bytes(problem.discs().size(), 0, 0), problem);
  const stream::Frame frame(problem);
  discs_ = stream::sort_discs(problem, frame, options);
  pilot_.emplace(problem, frame, discs_, rays, subtrees, options.stop);
}

std::unique_ptr<Index> PilotedDiscs::build(const Problem& problem, const BoxTreeParameters& parameters,
                                           const RunOptions& options) && {
  pilot_.reset();
  return prepare_box_tree(problem, std::move(discs_), parameters, options);
}

}  // namespace detp::sim
