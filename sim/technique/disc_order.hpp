#pragma once

#include <memory>

#include "detp/sim/base/unset_vector.hpp"
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

}  // namespace detp::sim
