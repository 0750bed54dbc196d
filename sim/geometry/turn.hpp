#pragma once

#include <array>
#include <cmath>

/// Cosine and sine of a part of a full turn, by the four operations alone: the same bits on every machine, and with vectors
/// (turn-inl.hpp). The standard library's differ from machine to machine in the last bit.
namespace detp::sim {

/// A unit vector of the plane.
struct Turn {
  double cos = 1;
  double sin = 0;
};

/// Coefficients of x⁰, x¹, … in cos(π/4 √x), and in sin(π/4 √x)/√x, for x ≤ 1: the series' first terms. What follows is below 3e-18.
namespace turn_series {
inline constexpr std::array cosine{1.0,
                                   -3.0842513753404245684e-1,
                                   1.5854344243815500852e-2,
                                   -3.2599188692739001364e-4,
                                   3.5908604485915100791e-6,
                                   -2.4611369504941997540e-8,
                                   1.1501159127974051523e-10,
                                   -3.8980731712596754401e-13,
                                   1.0018864616362720279e-15};
inline constexpr std::array sine{7.8539816339744830962e-1,  -8.0745512188280781707e-2,  2.4903945701927201600e-3,
                                 -3.6576204182177250787e-5, 3.1336168903781215210e-7,   -1.7572476734434010451e-9,
                                 6.9484532738866294089e-12, -2.0410263396641440529e-14, 4.6287046288346829736e-17};
}  // namespace turn_series

/// Cosine and sine of 2π `share`; the share is in [0, 1). Wrong by less than 3e-16.
///
/// The turn is split into eight parts. Place r in a part, in [0, 1], is exact; in every second part it counts from the part's end.
/// cos(π/4 r) and sin(π/4 r) are the cosine and sine, up to signs, or the other way round.
[[nodiscard]] inline Turn turn(double share) {
  const double eighths = 8 * share;
  const double part = std::floor(eighths);
  const auto number = static_cast<unsigned>(part);
  const double from_start = eighths - part;
  const double place = number % 2 == 1 ? 1 - from_start : from_start;
  const double square = place * place;
  const auto series = [square](const std::array<double, 9>& factors) {
    double sum = factors.back();
    for (std::size_t i = factors.size() - 1; i-- > 0;) sum = sum * square + factors[i];
    return sum;
  };
  const double near_one = series(turn_series::cosine);
  const double near_zero = place * series(turn_series::sine);
  const bool swapped = (number + 1) / 2 % 2 == 1;
  const double cosine = swapped ? near_zero : near_one;
  const double sine = swapped ? near_one : near_zero;
  return {number >= 2 && number < 6 ? -cosine : cosine, number >= 4 ? -sine : sine};
}

}  // namespace detp::sim
