#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"

namespace detp::validate {

/// What standard errors add to the time of a search, in seconds: for each hit 0.9 ns if each ray is a photon of its own, and
/// 9 ns if rays have photon numbers, because a disc's hits are then brought into the order of the rays. Measured on box trees
/// (one thread, AVX-512, 6.2·10⁶ hits of 50 000 discs: 76 ms without, 82 and 133 ms with errors). Scaled to the machine of
/// the costs by its time for a test of a ray against a disc.
[[nodiscard]] inline double standard_error_seconds(double hits, bool numbered, const CostTable& costs) {
  const double usual = built_in_unit_costs(costs.engine)[Technique::box_tree].disc_test;
  return hits * (numbered ? 9e-9 : 0.9e-9) * costs[Technique::box_tree].disc_test / usual;
}

}  // namespace detp::validate
