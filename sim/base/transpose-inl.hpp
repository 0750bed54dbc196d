// Included once for each instruction set (Highway's foreach_target), so no #pragma once.
#if defined(DETP_SIM_BASE_TRANSPOSE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DETP_SIM_BASE_TRANSPOSE_INL_HPP
#undef DETP_SIM_BASE_TRANSPOSE_INL_HPP
#else
#define DETP_SIM_BASE_TRANSPOSE_INL_HPP
#endif

#include <hwy/highway.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace detp::sim {
namespace HWY_NAMESPACE {

/// Writes the columns of an n × n matrix of doubles, n the number of lanes: 1, 2, 4 or 8. Consecutive rows are `stride` doubles apart.
/// (Gathers of eight lanes take three times as long on Zen 5.)
template <std::size_t stride, class Lanes>
HWY_INLINE void transpose(Lanes lanes, const double* rows, hwy::HWY_NAMESPACE::Vec<Lanes>* columns) {
  namespace hn = hwy::HWY_NAMESPACE;
#if HWY_TARGET == HWY_SCALAR
  columns[0] = hn::Load(lanes, rows);
#else
  using Doubles = hn::Vec<Lanes>;
  constexpr std::size_t n = hn::MaxLanes(Lanes());
  Doubles pairs[n];  // of rows 2 i and 2 i + 1: the even columns, then the odd ones
  for (std::size_t i = 0; i < n; i += 2) {
    const Doubles upper = hn::LoadU(lanes, rows + i * stride);
    const Doubles lower = hn::LoadU(lanes, rows + (i + 1) * stride);
    pairs[i] = hn::InterleaveLower(lanes, upper, lower);
    pairs[i + 1] = hn::InterleaveUpper(lanes, upper, lower);
  }
  if constexpr (n == 2) {
    columns[0] = pairs[0];
    columns[1] = pairs[1];
  } else {
    Doubles fours[n];  // of four rows: column j (0 … 3) and, if n is 8, column j + 4
    for (std::size_t i = 0; i < n; i += 4) {
      for (std::size_t odd = 0; odd < 2; ++odd) {
        const Doubles upper = pairs[i + odd];
        const Doubles lower = pairs[i + 2 + odd];
        fours[i + odd] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(lower), upper);
        fours[i + 2 + odd] = hn::OddEvenBlocks(lower, hn::SwapAdjacentBlocks(upper));
      }
    }
    for (std::size_t j = 0; j < 4; ++j) {
      if constexpr (n == 4) {
        columns[j] = fours[j];
      } else {
        columns[j] = hn::ConcatLowerLower(lanes, fours[4 + j], fours[j]);
        columns[4 + j] = hn::ConcatUpperUpper(lanes, fours[4 + j], fours[j]);
      }
    }
  }
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace detp::sim
HWY_AFTER_NAMESPACE();

#endif
