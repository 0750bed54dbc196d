#pragma once

#include <algorithm>
#include <vector>

#include "detp/sim/stop_check.hpp"
#include "technique.hpp"

namespace detp::sim {

/// Sorts by ray, then disc; false where a stop request ended it: the order is then any.
[[nodiscard]] inline bool sort_pairs(std::vector<Pair>& pairs, const std::stop_token& stop) {
  StopCheck check(stop, "sorting pairs");
  try {
    std::sort(pairs.begin(), pairs.end(), [&](const Pair& a, const Pair& b) {
      check.after(1);
      return a < b;
    });
  } catch (const Stopped&) {
    return false;
  }
  return true;
}

}  // namespace detp::sim
