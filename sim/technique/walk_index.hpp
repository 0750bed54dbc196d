#pragma once

#include <string>

#include "detp/sim/lists/list_walk.hpp"
#include "detp/sim/search/index.hpp"
#include "list_memory.hpp"

namespace detp::sim {

/// The parts of a technique whose spheres follow the discs.
struct WalkedSpheres {
  SampleOrder order = SampleOrder::lebesgue;  ///< in which the discs are visited
  MakeWalk make_walk;                         ///< makes a walk that has not met a disc yet
  NestedLists lists;                          ///< expected sizes of the walk's lists
  std::string what;                           ///< in messages: "4 spheres and their lists of rays"
};

/// Makes the index of a technique whose spheres follow the discs. The index holds the discs in the order of visits.
/// The search is in single precision, unless the engine is plain or rays start too far away.
[[nodiscard]] std::unique_ptr<Index> prepare_walk(const Problem& problem, WalkedSpheres spheres,
                                                  const RunOptions& options);

}  // namespace detp::sim
