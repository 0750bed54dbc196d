#pragma once

#include <array>
#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/mpfr.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

/// 100-digit arithmetic, the reference for formulas in double precision.
namespace detp::support {

using Exact =
    boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<100, boost::multiprecision::allocate_stack>,
                                  boost::multiprecision::et_off>;

inline Exact pi() { return boost::math::constants::pi<Exact>(); }

/// |value - exact| / |exact|, or |value| if exact is 0; infinite if the value is not finite.
///
/// If exact exceeds the largest double, the value is compared with the largest double. If exact is below the smallest
/// normal double, where doubles are evenly spaced, the error of a value within one spacing is 0.
inline double relative_error(double value, Exact exact) {
  using Limits = std::numeric_limits<double>;
  static const Exact largest = Limits::max();
  static const Exact least_normal = Limits::min();
  static const Exact least = Limits::denorm_min();
  if (!std::isfinite(value)) return Limits::infinity();
  if (exact > largest) exact = largest;
  if (exact < -largest) exact = -largest;
  const Exact off = abs(Exact{value} - exact);
  const Exact size = abs(exact);
  if (size < least_normal && off <= least) return 0;
  return static_cast<double>(size == 0 ? off : Exact{off / size});
}

/// baseⁿ by squaring, n >= 0.
inline Exact power(const Exact& base, std::int64_t n) {
  Exact result = 1;
  for (Exact square = base; n > 0; n /= 2) {
    if (n % 2 == 1) result *= square;
    if (n > 1) square *= square;
  }
  return result;
}

/// ∛x by Newton's method. x >= 0; x or its reciprocal must be within the range of doubles.
inline Exact cube_root(const Exact& x) {
  if (x == 0) return 0;
  int exponent = 0;
  const Exact mantissa = frexp(x, &exponent);
  const int thirds = (exponent + 6000) / 3 - 2000;
  const Exact scaled = ldexp(mantissa, exponent - 3 * thirds);  // 1/2 … 4
  Exact root = std::cbrt(static_cast<double>(scaled));
  for (int i = 0; i < 3; ++i) root -= (root * root * root - scaled) / (3 * root * root);  // 16, 32, 64, 128 digits
  return ldexp(root, thirds);
}

/// √x by Newton's method on 1/√x. x >= 0; x or its square must be within the range of doubles. Boost's function takes
/// five times as long.
inline Exact root_of(const Exact& x) {
  if (x == 0) return 0;
  int exponent = 0;
  const Exact mantissa = frexp(x, &exponent);
  const int halves = (exponent + 6000) / 2 - 3000;
  const Exact scaled = ldexp(mantissa, exponent - 2 * halves);  // 1/2 … 2
  Exact inverse = 1 / std::sqrt(static_cast<double>(scaled));
  for (int i = 0; i < 3; ++i) inverse += inverse * (1 - scaled * inverse * inverse) / 2;  // 16, 32, 64, 128 digits
  return ldexp(Exact{scaled * inverse}, halves);
}

/// ln(1 + z) for z from -1/40 to 1/40, by the series in y = z/(2 + z). 1 + z itself might lose digits of z.
inline Exact log_next_to_1(const Exact& z) {
  static const auto reciprocals = [] {
    std::array<Exact, 28> all;
    for (unsigned i = 0; i < all.size(); ++i) all[i] = Exact{1} / (2 * i + 1);
    return all;
  }();
  const Exact y = z / (2 + z);
  const Exact square = y * y;
  Exact sum = 0;
  for (auto term = reciprocals.rbegin(); term != reciprocals.rend(); ++term) sum = sum * square + *term;
  return 2 * y * sum;
}

/// ln x for x > 0: the sum of the logarithms of its power of two, of the nearest 32nd to the mantissa, and of the
/// remaining factor, which is close to 1.
inline Exact log_of(const Exact& x) {
  static const Exact log_of_2 = log(Exact{2});
  static const auto logs_of_32nds = [] {
    std::array<Exact, 65> all;
    for (unsigned i = 16; i < all.size(); ++i) all[i] = log(Exact{i} / 32);
    return all;
  }();
  int exponent = 0;
  Exact mantissa = frexp(x, &exponent);  // 1/2 … 1
  if (mantissa < 0.7071) {
    mantissa *= 2;
    --exponent;
  }
  const auto nearest = static_cast<unsigned>(std::lround(32 * static_cast<double>(mantissa)));
  return exponent * log_of_2 + logs_of_32nds[nearest] + log_next_to_1(32 * mantissa / nearest - 1);
}

/// eˣ for |x| <= 1e6: subtracts a multiple of ln 2, divides by 2¹⁶, sums the series, then squares sixteen times.
inline Exact exp_of(const Exact& x) {
  static const Exact log_of_2 = log(Exact{2});
  static const auto reciprocal_factorials = [] {
    std::array<Exact, 20> all;
    all[0] = 1;
    for (unsigned i = 1; i < all.size(); ++i) all[i] = all[i - 1] / i;
    return all;
  }();
  const int twos = static_cast<int>(std::lround(static_cast<double>(x) / std::log(2.0)));
  const Exact rest = ldexp(Exact{x - twos * log_of_2}, -16);
  Exact sum = 0;
  for (auto term = reciprocal_factorials.rbegin(); term != reciprocal_factorials.rend(); ++term)
    sum = sum * rest + *term;
  for (int i = 0; i < 16; ++i) sum *= sum;
  return ldexp(sum, twos);
}

}  // namespace detp::support
