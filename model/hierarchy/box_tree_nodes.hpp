#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::model::box_tree {

/// P(node) of nodes around clustered samples (Workload::nodes), instead of those around uniform ones.
///
/// The coefficients of the boxes around m discs are interpolated between the workload's, their logarithms linearly in
/// log m. Below the smallest m₀ of more than one disc, a length is proportional to
///
///     m^p (m - 1)/(m + 1)
///
///   where  p   that of the workload's edges between m₀ and 16 m₀, from 1/3 to 1
///          (m - 1)/(m + 1)   share of a side that m uniform points fill
///
/// and the coefficients that are no length are linear in 1/m, down to those of one disc.
///
/// Source     our derivation.
/// Accuracy   see sim/effects/README.md.
class ClusteredNodes {
 public:
  /// The workload has nodes. `margin` is the width by which the cull grows a box, in scene units.
  ClusteredNodes(const Valid<Workload>& workload, Engine engine, double margin);
  ClusteredNodes(Valid<Workload>&&, Engine, double) = delete;  ///< it would refer to a temporary

  /// P of a node with m >= 1 discs.
  [[nodiscard]] double crossing(double discs) const;

 private:
  [[nodiscard]] NodeBoxes boxes_of(double discs) const;

  const Valid<Workload>& workload_;  ///< outlives this
  Engine engine_;
  double margin_;  ///< of both ends
  double power_;   ///< p
};

}  // namespace detp::model::box_tree
