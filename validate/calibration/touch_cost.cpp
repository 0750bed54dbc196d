#include "touch_cost.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <limits>

#include "detp/sim/base/stopwatch.hpp"

namespace detp::validate {
namespace {

/// 0: not known.
double seconds_of_byte() {
  constexpr std::size_t bytes = std::size_t{8} << 20;  // of the size of a search's arrays
  constexpr int tries = 5;
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < tries; ++i) {
    void* const mapped = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapped == MAP_FAILED) return 0;
#ifdef MADV_HUGEPAGE
    madvise(mapped, bytes, MADV_HUGEPAGE);
#endif
    auto* const first = static_cast<volatile unsigned char*>(mapped);
    const sim::ProcessorStopwatch watch;
    for (std::size_t at = 0; at < bytes; at += page) first[at] = 1;
    least = std::min(least, watch.seconds() / static_cast<double>(bytes));
    munmap(mapped, bytes);
  }
  return least;
}

}  // namespace

void set_touch_cost(Calibration& calibration) {
  const double seconds = seconds_of_byte();
  if (!(seconds > 0)) return;
  for (const Engine engine : {Engine::simd, Engine::plain})
    for (const Technique technique : all_techniques) {
      calibration.of(engine).costs[technique].touch = seconds;
      if (auto& fit = calibration.of(engine).fits[static_cast<std::size_t>(technique)]) fit->costs.touch = seconds;
    }
}

}  // namespace detp::validate
