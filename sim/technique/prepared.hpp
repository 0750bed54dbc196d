#pragma once

#include <memory>

#include "technique.hpp"

namespace detp::sim {

/// An index that stands over a problem's discs, ready to be searched by its rays: once, or block after block.
///
/// It borrows the problem, whose rays may be others at each search, as long as no origin is farther from S₀ than the
/// problem's slack allows for (set_rays). What is counted of building it (references, placements) is told by every
/// search.
class Prepared {
 public:
  virtual ~Prepared() = default;

  /// Searches the rays that the problem has now. Does not set the times.
  virtual void search(const RunOptions& options, Outcome& outcome) const = 0;

  /// Of memory that it holds.
  [[nodiscard]] virtual std::size_t bytes() const = 0;
};

/// Builds the index of a technique that has one, to be searched with these options; null for all others. Throws as run
/// does, and Stopped if a stop was requested.
[[nodiscard]] std::unique_ptr<Prepared> prepare(const Problem& problem, const Candidate& candidate,
                                                const RunOptions& options);

[[nodiscard]] std::unique_ptr<Prepared> prepare_octree(const Problem& problem, const OctreeParameters& parameters,
                                                       const std::stop_token& stop);
[[nodiscard]] std::unique_ptr<Prepared> prepare_grid(const Problem& problem, const GridParameters& parameters,
                                                     const std::stop_token& stop);
[[nodiscard]] std::unique_ptr<Prepared> prepare_bvh(const Problem& problem, const BvhParameters& parameters,
                                                    int threads, const std::stop_token& stop);
[[nodiscard]] std::unique_ptr<Prepared> prepare_bsp(const Problem& problem, const BspParameters& parameters,
                                                    const std::stop_token& stop);

}  // namespace detp::sim
