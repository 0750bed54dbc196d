#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::model {

/// Parameters of a box tree that suit the workload. A node has 4 children. A leaf has 64 discs if there are fewer rays
/// than discs (building the tree then takes longer than searching it), 8 discs if there are at least 64 rays per
/// disc, else 16.
///
/// A rule of thumb, measured on seven workloads of 10³ … 10⁶ rays and discs. With leaves twice or half as large, a run
/// took 1.0 to 1.2 times as long; with leaves four times or a quarter as large, up to 1.8 times.
[[nodiscard]] inline BoxTreeParameters box_tree_rule(const Valid<Workload>& workload) {
  constexpr int fan_out = 4;
  const double rays_a_disc = workload.rays / workload.samples;
  const int leaf = rays_a_disc < 1 ? 64 : rays_a_disc < 64 ? 16 : 8;
  return {fan_out, leaf};
}

}  // namespace detp::model
