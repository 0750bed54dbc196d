#pragma once

#include <algorithm>
#include <vector>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "outcome.hpp"

namespace detp::sim {

/// Appends a pair. Throws std::length_error before the array would exceed the memory budget.
template <class Pairs>
void add_pair(Pairs& pairs, const Pair& pair) {
  if (pairs.size() == pairs.capacity()) require_memory("the pairs", grown_bytes(pairs.size() + 1, sizeof(Pair)));
  pairs.push_back(pair);
}

/// Sorts by ray, then disc. Returns false if a stop request ended the sort; the order is then unspecified.
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
