#pragma once

#include <algorithm>
#include <limits>

namespace detp {

/// Converts a result to double: rounds to nearest, and replaces values beyond the range of doubles by the largest
/// double of the same sign.
///
/// Some formulas have factors beyond the range of doubles although their result is within it. They are evaluated in
/// long double and then converted by this function. Needs x87 long double (64-bit mantissa).
[[nodiscard]] inline double saturated(long double value) {
  constexpr long double largest = std::numeric_limits<double>::max();
  return static_cast<double>(std::clamp(value, -largest, largest));
}

}  // namespace detp
