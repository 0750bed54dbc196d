#pragma once

#include <algorithm>
#include <limits>

namespace detp {

/// A result as a double: rounded to nearest; the largest double of its sign where it lies beyond the range of doubles.
///
/// Formulas whose factors may leave that range, though the result does not, are evaluated in long double and end here.
/// Accuracy then depends on long double having x87's 64 bits and range; what it brings is told at each formula.
[[nodiscard]] inline double saturated(long double value) {
  constexpr long double largest = std::numeric_limits<double>::max();
  return static_cast<double>(std::clamp(value, -largest, largest));
}

}  // namespace detp
