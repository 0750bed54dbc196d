#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace detp::validate {

/// While it exists, this thread treats denormal numbers as zero, as Embree's documentation strongly recommends. The
/// destructor restores the previous state, because the exact techniques rely on denormals.
class FlushDenormals {
 public:
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

#if defined(__SSE2__)
  FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | flush_to_zero | denormals_are_zero); }
  ~FlushDenormals() { _mm_setcsr(before_); }

 private:
  static constexpr unsigned flush_to_zero = 0x8000;
  static constexpr unsigned denormals_are_zero = 0x0040;
  unsigned before_;
#else
  FlushDenormals() = default;
#endif
};

/// Stores four floats at once, to an address divisible by 16. Embree loads the four floats as a vector. Its
/// documentation warns that four single stores would stall this load.
inline void store_four(float* to, float a, float b, float c, float d) {
#if defined(__SSE2__)
  _mm_store_ps(to, _mm_setr_ps(a, b, c, d));
#else
  to[0] = a;
  to[1] = b;
  to[2] = c;
  to[3] = d;
#endif
}

}  // namespace detp::validate
