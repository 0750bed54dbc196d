#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <random>
#include <vector>

namespace detp::validate {

/// Calls begin(round) before each round, and in it run(i, round) for each contender i; ends as soon as one of them returns
/// false. Because contenders take turns, a disturbance of the machine affects all of them alike. Each round after the
/// first has another order, so that none of them always finds the caches as the same other one left them.
template <class Begin, class Run>
void in_turns(std::size_t contenders, int rounds, const Begin& begin, const Run& run) {
  std::vector<std::size_t> order(contenders);
  std::iota(order.begin(), order.end(), 0U);
  std::minstd_rand random;
  for (int round = 0; round < rounds && contenders > 0; ++round) {
    if (!begin(round)) return;
    for (const std::size_t i : order)
      if (!run(i, round)) return;
    std::shuffle(order.begin(), order.end(), random);
  }
}

}  // namespace detp::validate
