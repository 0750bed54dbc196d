#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cstdint>

/// 100-digit arithmetic, to test formulas in double precision against.
namespace detp::support {

using Exact = boost::multiprecision::cpp_bin_float_100;

/// |value - exact| / |exact|, or |value| where exact is 0.
inline double relative_error(double value, const Exact& exact) {
  const Exact off = abs(Exact{value} - exact);
  return static_cast<double>(exact == 0 ? off : Exact{off / abs(exact)});
}

/// baseⁿ by one multiplication after the other for few, by squaring for many.
inline Exact power(const Exact& base, std::int64_t n) {
  if (n == 0) return 1;
  if (n < 64) return base * power(base, n - 1);
  const Exact half = power(base, n / 2);
  return n % 2 == 0 ? Exact{half * half} : Exact{half * half * base};
}

/// ∛x by Newton's method, for x from 1e-30 to 1e30.
inline Exact cube_root(const Exact& x) {
  Exact root = std::cbrt(static_cast<double>(x));
  for (int i = 0; i < 4; ++i) root -= (root * root * root - x) / (3 * root * root);
  return root;
}

}  // namespace detp::support
