// Included once for each instruction set (Highway's foreach_target), so no #pragma once.
#if defined(DETP_SIM_GEOMETRY_TURN_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DETP_SIM_GEOMETRY_TURN_INL_HPP
#undef DETP_SIM_GEOMETRY_TURN_INL_HPP
#else
#define DETP_SIM_GEOMETRY_TURN_INL_HPP
#endif

#include <hwy/highway.h>

#include <array>

#include "turn.hpp"

HWY_BEFORE_NAMESPACE();
namespace detp::sim {
namespace HWY_NAMESPACE {

template <class Doubles>
struct Turns {
  Doubles cos;
  Doubles sin;
};

/// turn() for each lane: the same operations, so the same bits. (Never MulAdd: it rounds once where an instruction set has it, and
/// twice where not.)
template <class Lanes>
HWY_INLINE auto turns(Lanes lanes, hwy::HWY_NAMESPACE::Vec<Lanes> shares) {
  namespace hn = hwy::HWY_NAMESPACE;
  using Doubles = hn::Vec<Lanes>;
  const auto of = [lanes](double value) { return hn::Set(lanes, value); };
  const auto is_odd = [&](Doubles whole) {
    const Doubles half = hn::Mul(whole, of(0.5));
    return hn::Ne(half, hn::Floor(half));
  };
  const Doubles eighths = hn::Mul(of(8), shares);
  const Doubles part = hn::Floor(eighths);
  const Doubles from_start = hn::Sub(eighths, part);
  const Doubles place = hn::IfThenElse(is_odd(part), hn::Sub(of(1), from_start), from_start);
  const Doubles square = hn::Mul(place, place);
  const auto series = [&](const std::array<double, 9>& factors) {
    Doubles sum = of(factors.back());
    for (std::size_t i = factors.size() - 1; i-- > 0;) sum = hn::Add(hn::Mul(sum, square), of(factors[i]));
    return sum;
  };
  const Doubles near_one = series(turn_series::cosine);
  const Doubles near_zero = hn::Mul(place, series(turn_series::sine));
  const auto swapped = is_odd(hn::Floor(hn::Mul(hn::Add(part, of(1)), of(0.5))));
  const Doubles cosine = hn::IfThenElse(swapped, near_zero, near_one);
  const Doubles sine = hn::IfThenElse(swapped, near_one, near_zero);
  const auto left = hn::And(hn::Ge(part, of(2)), hn::Lt(part, of(6)));
  return Turns<Doubles>{hn::IfThenElse(left, hn::Neg(cosine), cosine),
                        hn::IfThenElse(hn::Ge(part, of(4)), hn::Neg(sine), sine)};
}

}  // namespace HWY_NAMESPACE
}  // namespace detp::sim
HWY_AFTER_NAMESPACE();

#endif
