// Included once for each instruction set (Highway's foreach_target), so no #pragma once.
#if defined(DETP_SIM_STREAM_KEPT_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DETP_SIM_STREAM_KEPT_LANES_INL_HPP
#undef DETP_SIM_STREAM_KEPT_LANES_INL_HPP
#else
#define DETP_SIM_STREAM_KEPT_LANES_INL_HPP
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "kept_lanes_table.hpp"

HWY_BEFORE_NAMESPACE();
namespace detp::sim::stream {
namespace HWY_NAMESPACE {

/// The numbers of the lanes in a set of up to eight, given by its bits, in order; then those of the others.
template <class Lanes>
HWY_INLINE auto kept_lanes([[maybe_unused]] Lanes lanes, std::uint8_t bits) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::RebindToSigned<Lanes> numbers;
#if HWY_TARGET == HWY_SCALAR
  (void)bits;
  return hn::Zero(numbers);
#else
  const hn::Rebind<std::uint8_t, decltype(numbers)> bytes;
  return hn::PromoteTo(numbers, hn::LoadU(bytes, kept_lanes_table[bits].data()));
#endif
}

/// The numbers of the lanes that `kept` holds, in order; then others.
///
/// Without AVX-512, Highway's Compress looks them up in a table that is local to its function. GCC 12 copies that table, 1 KiB,
/// to the stack at each call, which took over half of the time of culling with AVX2.
template <class Lanes>
HWY_INLINE auto kept_lanes([[maybe_unused]] Lanes lanes, hwy::HWY_NAMESPACE::Mask<Lanes> kept) {
  namespace hn = hwy::HWY_NAMESPACE;
#if HWY_ARCH_X86 && HWY_TARGET > HWY_AVX3 && HWY_TARGET < HWY_EMU128
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(lanes, kept, bits);
  return kept_lanes(lanes, bits[0]);
#else
  const hn::RebindToSigned<Lanes> numbers;
  return hn::Compress(hn::Iota(numbers, 0), hn::RebindMask(numbers, kept));
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace detp::sim::stream
HWY_AFTER_NAMESPACE();

#endif
