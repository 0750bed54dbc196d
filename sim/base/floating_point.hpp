#pragma once

#include <cfenv>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

/// The floating-point mode of a thread: rounding, whether subnormal numbers are flushed to zero, which exceptions trap.
namespace detp::sim {

/// While it exists, its thread is in the default mode: rounds to nearest, keeps subnormal numbers, traps no exception.
/// Then restores the mode that the thread had before. Takes some nanoseconds if that was the default mode, or the same with
/// flushing to zero.
///
/// All parallel code of detp (parallel.hpp, on_threads) and each function that a program calls to search, trace, plan or
/// calibrate is in this mode, so that results do not depend on the caller's mode. oneTBB's own rule is another: its tasks
/// have the mode in which the thread was when oneTBB first ran in it. That may be Embree's mode, which flushes to zero.
class DefaultFloatingPoint {
 public:
  DefaultFloatingPoint() {
#if defined(__SSE__)
    register_ = _mm_getcsr();
    const unsigned settings = register_ & all_settings;
    if (settings == default_settings) return;
    if ((settings & ~flushing) == default_settings) {
      restore_ = Restore::flushing;
      _mm_setcsr(register_ & ~flushing);
      return;
    }
#endif
    restore_ = Restore::all;
    std::fegetenv(&before_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultFloatingPoint() {
#if defined(__SSE__)
    if (restore_ == Restore::flushing) _mm_setcsr(register_);
#endif
    if (restore_ == Restore::all) std::fesetenv(&before_);
  }
  DefaultFloatingPoint(const DefaultFloatingPoint&) = delete;
  DefaultFloatingPoint& operator=(const DefaultFloatingPoint&) = delete;

 private:
  enum class Restore { none, flushing, all };

  // Bits of the register MXCSR. Its other bits are flags.
  static constexpr unsigned all_settings = 0xFFC0;
  static constexpr unsigned default_settings = 0x1F80;  // exceptions masked, nothing else
  static constexpr unsigned flushing = 0x8040;          // of results and of arguments

  Restore restore_ = Restore::none;
  unsigned register_ = 0;
  std::fenv_t before_;  ///< set if all is restored: saving it takes much longer than the register
};

}  // namespace detp::sim
