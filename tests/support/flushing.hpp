#pragma once

#include <immintrin.h>

/// The floating-point mode of code that flushes subnormal numbers to zero, as many renderers and Embree do.
namespace detp::support {

/// While it exists, its thread flushes subnormal numbers to zero, as arguments and as results.
class Flushing {
 public:
  Flushing() { _mm_setcsr(before_ | 0x8040U); }
  ~Flushing() { _mm_setcsr(before_); }
  Flushing(const Flushing&) = delete;
  Flushing& operator=(const Flushing&) = delete;

 private:
  unsigned before_ = _mm_getcsr();
};

/// Whether this thread loses a subnormal number.
inline bool flushes() {
  volatile double tiny = 1e-310;
  tiny = tiny * 0.5;
  volatile double zero = 0;
  return !(tiny > zero);
}

}  // namespace detp::support
