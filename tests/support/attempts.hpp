#pragma once

#include <doctest/doctest.h>

namespace detp::support {

/// Whether `holds()` in one of at most so many attempts: for what other jobs on the machine can hide, but not feign. Prints each that failed.
template <class Holds>
[[nodiscard]] bool in_attempts(int most, const Holds& holds) {
  for (int attempt = 1; attempt <= most; ++attempt) {
    if (holds()) return true;
    MESSAGE("attempt ", attempt, " of ", most, " failed");
  }
  return false;
}

}  // namespace detp::support
