#pragma once

#include <string>

#include "detp/sim/lists/list_walk.hpp"
#include "detp/sim/search/index.hpp"
#include "list_memory.hpp"

namespace detp::sim {

/// What a technique whose spheres follow the discs is made of.
struct WalkedSpheres {
  SampleOrder order = SampleOrder::lebesgue;  ///< in which the discs are visited
  MakeWalk make_walk;                         ///< of a walk that has not yet met a disc
  NestedLists lists;                          ///< what its lists are expected to take
  std::string what;                           ///< in messages: "4 spheres and their lists of rays"
};

/// The index of such a technique: its discs in order. In single precision unless the engine is plain or rays start too
/// far away for that.
[[nodiscard]] std::unique_ptr<Index> prepare_walk(const Problem& problem, WalkedSpheres spheres,
                                                  const RunOptions& options);

}  // namespace detp::sim
