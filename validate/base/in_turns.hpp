#pragma once

#include <cstddef>

namespace detp::validate {

/// Rounds of timed runs, of each contender once a round, so that a disturbance of the machine hits all alike: run(i,
/// round) says whether to go on.
template <class Run>
void in_turns(std::size_t contenders, int rounds, const Run& run) {
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < contenders; ++i)
      if (!run(i, round)) return;
}

}  // namespace detp::validate
