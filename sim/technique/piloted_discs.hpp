#pragma once

#include <memory>
#include <optional>

#include "detp/sim/base/page_pool.hpp"
#include "detp/sim/lists/pilot/box_tree_pilot.hpp"
#include "detp/sim/lists/simd/search.hpp"
#include "detp/sim/search/index.hpp"

namespace detp::sim {

/// The discs' order along the curve, sorted once, for box trees over these discs with any radii. Const and shared by its
/// copies: 8 bytes a disc.
class DiscOrder {
 public:
  /// Sorts the problem's discs. Throws Stopped if a stop was requested, and std::length_error for 2³¹ or more discs.
  DiscOrder(const Problem& problem, const RunOptions& options);

  /// Builds a box tree without sorting. The problem's discs must have the centres of those that were sorted, in the same
  /// sequence; their normals and radii may be others. (Other centres make the tree slow, not wrong.) Throws as
  /// sim::prepare, and std::invalid_argument if the number of discs differs.
  [[nodiscard]] std::unique_ptr<Index> prepare(const Problem& problem, const BoxTreeParameters& parameters,
                                               const RunOptions& options) const;

 private:
  friend class PilotedDiscs;
  using Places = std::shared_ptr<const UnsetVector<std::uint64_t>>;  ///< stream::CurveOrder
  explicit DiscOrder(Places places) : places_(std::move(places)) {}

  Places places_;
};

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
