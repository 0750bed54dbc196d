#pragma once

#include "detp/sim/index/disc_index.hpp"

/// Runs the variants of an index.
namespace detp::support {

/// Searches an index once. The counts include building and searching.
inline sim::Outcome search_once(const sim::Index& index, const sim::Problem& problem, const sim::RunOptions& options) {
  sim::Outcome outcome = sim::search(index, problem, options);
  outcome.counts += index.built().counts;
  return outcome;
}

inline sim::Outcome search_octree(const sim::Problem& problem, const OctreeParameters& parameters,
                                  const IndexVariant& variant, const sim::RunOptions& options = {}) {
  return search_once(*sim::index_octree(problem, parameters, variant, options), problem, options);
}

inline sim::Outcome search_grid(const sim::Problem& problem, const GridParameters& parameters,
                                const IndexVariant& variant, const sim::RunOptions& options = {}) {
  return search_once(*sim::index_grid(problem, parameters, variant, options), problem, options);
}

}  // namespace detp::support
