#pragma once

#include <cstddef>

namespace detp::validate {

/// Calls run(i, round) for each contender i, round after round, until it returns false. A disturbance of the machine
/// then affects all contenders alike.
template <class Run>
void in_turns(std::size_t contenders, int rounds, const Run& run) {
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < contenders; ++i)
      if (!run(i, round)) return;
}

}  // namespace detp::validate
