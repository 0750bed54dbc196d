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

DiscOrder::DiscOrder(const Problem& problem, const RunOptions& options)
    : places_(stream::curve_order(problem, options)) {}

std::unique_ptr<Index> DiscOrder::prepare(const Problem& problem, const BoxTreeParameters& parameters,
                                          const RunOptions& options) const {
  check_options(options, problem);
  check(parameters);
  return prepare_box_tree(problem, stream::discs_in_known_order(problem, stream::Frame(problem), places_, options),
                          parameters, options);
}

}  // namespace detp::sim
