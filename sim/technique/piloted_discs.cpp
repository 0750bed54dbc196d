#include "piloted_discs.hpp"

#include <utility>

#include "box_tree.hpp"
#include "detp/sim/base/stopwatch.hpp"

namespace detp::sim {

PilotedDiscs::PilotedDiscs(const Problem& problem, std::span<const Ray> sample, double rays, std::size_t subtrees,
                           const RunOptions& options) {
  Stopwatch watch;
  const stream::Frame frame(problem);
  discs_ = stream::sort_discs(problem, frame, options);
  sort_seconds_ = watch.lap();
  pilot_.emplace(problem, frame, discs_, sample, rays, subtrees, options.stop);
  pilot_seconds_ = watch.lap();
}

std::unique_ptr<Index> PilotedDiscs::build(const Problem& problem, const BoxTreeParameters& parameters,
                                           const RunOptions& options) && {
  pilot_.reset();
  return prepare_box_tree(problem, std::move(discs_), parameters, options);
}

}  // namespace detp::sim
