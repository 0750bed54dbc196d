#pragma once

#include <cstddef>

namespace detp::validate {

/// Calls run(i, round) for each contender i, round after round, and ends as soon as a call returns false. Because
/// contenders take turns, a disturbance of the machine affects all of them alike.
template <class Run>
void in_turns(std::size_t contenders, int rounds, const Run& run) {
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < contenders; ++i)
      if (!run(i, round)) return;
}

}  // namespace detp::validate
