#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::model {

/// A box tree that suits the workload: 4 children a node; leaves of 64 where there are fewer rays than
/// discs (the tree takes longer to build than to search), of 8 from 64 rays a disc, of 16 between.
///
/// A rule of thumb, measured on seven workloads of 10³ … 10⁶ rays and discs: leaves twice or half as large took 1.0
/// to 1.2 times as long, four times as large or small up to 1.8.
[[nodiscard]] inline BoxTreeParameters box_tree_rule(const Valid<Workload>& workload) {
  constexpr int fan_out = 4;
  const double rays_a_disc = workload.rays / workload.samples;
  const int leaf = rays_a_disc < 1 ? 64 : rays_a_disc < 64 ? 16 : 8;
  return {fan_out, leaf};
}

}  // namespace detp::model
