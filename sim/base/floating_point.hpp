#pragma once

#include <cfenv>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

/// The floating-point mode of a thread: rounding, whether subnormal numbers are flushed to zero, which exceptions trap.
namespace detp::sim {

/// While it exists, its thread is in the default mode: rounds to nearest, keeps subnormal numbers, traps no exception.
/// Then restores the mode that the thread had before. Takes some nanoseconds if that was the default mode.
///
/// All parallel code of detp (parallel.hpp, on_threads) and each function that a program calls to search, trace, plan or
/// calibrate is in this mode, so that results do not depend on the caller's mode. oneTBB's own rule is another: its tasks
/// have the mode in which the thread was when oneTBB first ran in it. That may be Embree's mode, which flushes to zero.
class DefaultFloatingPoint {
 public:
  DefaultFloatingPoint() : changed_(!is_default()) {
    if (!changed_) return;
    std::fegetenv(&before_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultFloatingPoint() {
    if (changed_) std::fesetenv(&before_);
  }
  DefaultFloatingPoint(const DefaultFloatingPoint&) = delete;
  DefaultFloatingPoint& operator=(const DefaultFloatingPoint&) = delete;

 private:
  [[nodiscard]] static bool is_default() {
#if defined(__SSE__)
    constexpr unsigned settings = 0xFFC0;          // of the register MXCSR; its other bits are flags
    constexpr unsigned default_settings = 0x1F80;  // exceptions masked, nothing else
    return (_mm_getcsr() & settings) == default_settings;
#else
    return false;  // not known
#endif
  }

  bool changed_;
  std::fenv_t before_{};
};

}  // namespace detp::sim
