#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::model {

/// A box tree that suits the workload: 4 children a node; leaves of 64 if there are fewer rays than discs (building the
/// tree then takes longer than searching it), of 8 from 64 rays a disc, of 16 in between.
///
/// A rule of thumb, measured on seven workloads of 10³ … 10⁶ rays and discs: with leaves twice or half as large a run
/// took 1.0 to 1.2 times as long, with leaves four times as large or small up to 1.8 times.
[[nodiscard]] inline BoxTreeParameters box_tree_rule(const Valid<Workload>& workload) {
  constexpr int fan_out = 4;
  const double rays_a_disc = workload.rays / workload.samples;
  const int leaf = rays_a_disc < 1 ? 64 : rays_a_disc < 64 ? 16 : 8;
  return {fan_out, leaf};
}

}  // namespace detp::model
