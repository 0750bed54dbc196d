#pragma once

#include <memory>
#include <optional>

#include "detp/sim/lists/simd/box_tree_pilot.hpp"
#include "detp/sim/lists/simd/search.hpp"
#include "detp/sim/search/index.hpp"
#include "disc_order.hpp"

namespace detp::sim {

/// Discs, sorted once: first a pilot predicts the counts of box trees with any parameters, then the best one is built.
class PilotedDiscs {
 public:
  /// Whether float kernels can search the problem. A pilot needs them.
  [[nodiscard]] static bool can_pilot(const Problem& problem) { return stream::can_search(problem); }

  /// Sorts the problem's discs, and culls the sample. Throws as BoxTreePilot, and std::length_error, naming the bytes, if
  /// the discs would not fit in memory.
  PilotedDiscs(const Problem& problem, const stream::PilotRays& rays, std::size_t subtrees, const RunOptions& options);

  PilotedDiscs(const PilotedDiscs&) = delete;
  PilotedDiscs& operator=(const PilotedDiscs&) = delete;

  /// The predicted counts of a search of all rays, building included. As stream::BoxTreePilot::counts.
  [[nodiscard]] stream::PilotCounts counts(const BoxTreeParameters& parameters, bool growth = false) const {
    return pilot_->counts(parameters, growth);
  }

  /// Builds the box tree. Sorting is not repeated; its time is part of the index's. The problem must be that of the
  /// constructor. Call it once. Throws as `prepare`.
  [[nodiscard]] std::unique_ptr<Index> build(const Problem& problem, const BoxTreeParameters& parameters,
                                             const RunOptions& options) &&;

  /// The discs' order, for trees with other radii. Not after `build`.
  [[nodiscard]] DiscOrder order() const { return DiscOrder(discs_.places); }

  [[nodiscard]] double sort_seconds() const { return discs_.seconds; }

 private:
  stream::SortedDiscs discs_;
  std::optional<stream::BoxTreePilot> pilot_;  ///< refers to discs_
};

}  // namespace detp::sim
