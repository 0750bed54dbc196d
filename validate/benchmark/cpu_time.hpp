#pragma once

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <limits>

namespace detp::benchmarks {

/// CPU time of the process, seconds: what others do on the machine counts as little as can be.
[[nodiscard]] inline double cpu_time() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Seconds of one call: the least of several measurements of `calls` calls each.
template <class Work>
double least_time(std::size_t calls, const Work& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < 9; ++repeat) {
    const double start = cpu_time();
    for (std::size_t call = 0; call < calls; ++call) work();
    least = std::min(least, cpu_time() - start);
  }
  return least / static_cast<double>(calls);
}

}  // namespace detp::benchmarks
