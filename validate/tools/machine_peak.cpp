#include "kernel_table.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detp/validate/tools/machine_peak.cpp"
#include <hwy/foreach_target.h>
// highway.h must come after foreach_target.h.
#include <hwy/aligned_allocator.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/lists/simd/kept_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace detp::benchmarks {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, 16>;

/// Fourteen independent chains of multiply-adds. Eight chains would be enough for two units with a latency of four
/// cycles. The chains start with different values, because the compiler would merge equal chains.
float MultiplyAndAdd(std::size_t times) {
  const Lanes lanes;
  const auto x = hn::Set(lanes, 0.75F);
  const auto y = hn::Iota(lanes, 1.0F);
  auto s0 = y, s1 = y + s0, s2 = y + s1, s3 = y + s2, s4 = y + s3, s5 = y + s4, s6 = y + s5;
  auto t0 = y + s6, t1 = y + t0, t2 = y + t1, t3 = y + t2, t4 = y + t3, t5 = y + t4, t6 = y + t5;
  for (std::size_t i = 0; i < times; ++i) {
    s0 = hn::MulAdd(s0, x, x), s1 = hn::MulAdd(s1, x, x), s2 = hn::MulAdd(s2, x, x), s3 = hn::MulAdd(s3, x, x);
    s4 = hn::MulAdd(s4, x, x), s5 = hn::MulAdd(s5, x, x), s6 = hn::MulAdd(s6, x, x), t0 = hn::MulAdd(t0, x, x);
    t1 = hn::MulAdd(t1, x, x), t2 = hn::MulAdd(t2, x, x), t3 = hn::MulAdd(t3, x, x), t4 = hn::MulAdd(t4, x, x);
    t5 = hn::MulAdd(t5, x, x), t6 = hn::MulAdd(t6, x, x);
  }
  const auto s = s0 + s1 + s2 + s3 + s4 + s5 + s6;
  return hn::GetLane(hn::SumOfLanes(lanes, s + (t0 + t1 + t2 + t3 + t4 + t5 + t6)));
}

float LoadAll(const float* from, std::size_t size) {
  const Lanes lanes;
  const std::size_t n = hn::Lanes(lanes);
  auto s0 = hn::Zero(lanes), s1 = s0, s2 = s0, s3 = s0;
  for (std::size_t i = 0; i + 4 * n <= size; i += 4 * n) {
    s0 = hn::Or(s0, hn::Load(lanes, from + i));
    s1 = hn::Or(s1, hn::Load(lanes, from + i + n));
    s2 = hn::Or(s2, hn::Load(lanes, from + i + 2 * n));
    s3 = hn::Or(s3, hn::Load(lanes, from + i + 3 * n));
  }
  return hn::GetLane(hn::Or(hn::Or(s0, s1), hn::Or(s2, s3)));
}

void StoreAll(float* to, std::size_t size) {
  const Lanes lanes;
  const std::size_t n = hn::Lanes(lanes);
  const auto x = hn::Set(lanes, 1.0F);
  for (std::size_t i = 0; i + 4 * n <= size; i += 4 * n) {
    hn::Store(x, lanes, to + i);
    hn::Store(x, lanes, to + i + n);
    hn::Store(x, lanes, to + i + 2 * n);
    hn::Store(x, lanes, to + i + 3 * n);
  }
}

/// Packs `arrays` arrays of `size` floats. In `from` and `to`, each array starts `stride` floats after the array before
/// it.
template <Packing packing, int arrays>
std::size_t pack(const float* from, float* to, std::size_t size, std::size_t stride, const std::uint8_t* bits) {
  const Lanes lanes;
  std::size_t end = 0;
  for (std::size_t i = 0; i < size; i += hn::Lanes(lanes)) {
    const auto kept = hn::LoadMaskBits(lanes, bits + i / hn::Lanes(lanes) * 8);
    const auto places = hn::IndicesFromVec(lanes, sim::stream::HWY_NAMESPACE::kept_lanes(lanes, kept));
    for (std::size_t k = 0; k < arrays; ++k) {
      const auto v = hn::Load(lanes, from + k * stride + i);
      const auto packed = packing == Packing::compress ? hn::Compress(v, kept) : hn::TableLookupLanes(v, places);
      hn::StoreU(packed, lanes, to + k * stride + end);
    }
    end += hn::CountTrue(lanes, kept);
  }
  return end;
}

/// The same, two vectors at a time.
template <int arrays>
std::size_t pack_pairs(const float* from, float* to, std::size_t size, std::size_t stride, const std::uint8_t* bits) {
#if HWY_TARGET <= HWY_AVX3
  const Lanes lanes;
  const hn::RebindToUnsigned<Lanes> words;
  std::size_t end = 0;
  for (std::size_t i = 0; i < size; i += 32) {
    const auto kept = hn::LoadMaskBits(words, bits + i / 2);
    const auto more = hn::LoadMaskBits(words, bits + i / 2 + 8);
    const std::size_t count = hn::CountTrue(words, kept);
    const auto of_more = hn::Compress(hn::Iota(words, 16), more);
    const auto places = _mm512_mask_expand_epi32(hn::Compress(hn::Iota(words, 0), kept).raw,
                                                 static_cast<__mmask16>(0xffffU << count), of_more.raw);
    const std::size_t all = count + hn::CountTrue(words, more);
    for (std::size_t k = 0; k < arrays; ++k) {
      const auto x = hn::Load(lanes, from + k * stride + i);
      const auto y = hn::Load(lanes, from + k * stride + i + 16);
      _mm512_storeu_ps(to + k * stride + end, _mm512_permutex2var_ps(x.raw, places, y.raw));
      if (HWY_UNLIKELY(all > 16))
        hn::StoreU(hn::TableLookupLanes(y, hn::IndicesFromVec(lanes, hn::And(of_more, hn::Set(words, 15)))), lanes,
                   to + k * stride + end + count);
    }
    end += all;
  }
  return end;
#else
  return pack<Packing::permute, arrays>(from, to, size, stride, bits);
#endif
}

std::size_t Pack(Packing packing, int arrays, const float* from, float* to, std::size_t size, std::size_t stride,
                 const std::uint8_t* bits) {
  if (packing == Packing::compress)
    return arrays == 5 ? pack<Packing::compress, 5>(from, to, size, stride, bits)
                       : pack<Packing::compress, 7>(from, to, size, stride, bits);
  if (packing == Packing::pairs)
    return arrays == 5 ? pack_pairs<5>(from, to, size, stride, bits) : pack_pairs<7>(from, to, size, stride, bits);
  return arrays == 5 ? pack<Packing::permute, 5>(from, to, size, stride, bits)
                     : pack<Packing::permute, 7>(from, to, size, stride, bits);
}

std::size_t VectorLength() { return hn::Lanes(Lanes()); }

const char* Instructions() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace detp::benchmarks
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace detp::benchmarks {

HWY_EXPORT(MultiplyAndAdd);
HWY_EXPORT(LoadAll);
HWY_EXPORT(StoreAll);
HWY_EXPORT(Pack);
HWY_EXPORT(VectorLength);
HWY_EXPORT(Instructions);

namespace {

/// About the number of floats that a loop processes in one measurement, so that it takes a few milliseconds.
constexpr std::size_t floats_moved = std::size_t{1} << 24;

/// Vector multiply-adds in one iteration of MultiplyAndAdd.
constexpr std::size_t chains = 14;

/// Space behind an array and between arrays, so that they do not start at the same offset in a page.
constexpr std::size_t gap = 80;

template <class Work>
double least_time(std::size_t calls, const Work& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < 9; ++repeat) {
    const sim::ProcessorStopwatch watch;
    for (std::size_t call = 0; call < calls; ++call) work();
    least = std::min(least, watch.seconds());
  }
  return least / static_cast<double>(calls);
}

hwy::AlignedFreeUniquePtr<float[]> ones(std::size_t size) {
  auto array = hwy::AllocateAligned<float>(size);
  std::fill_n(array.get(), size, 1.0F);
  return array;
}

}  // namespace

double peak_flops() {
  constexpr std::size_t times = 1'000'000;
  volatile float kept = 0;
  const double seconds = least_time(1, [&] { kept = HWY_DYNAMIC_DISPATCH(MultiplyAndAdd)(times); });
  return static_cast<double>(2 * chains * times * vector_length()) / seconds;
}

double load_bandwidth(std::size_t bytes) {
  const std::size_t size = bytes / sizeof(float);
  const auto from = ones(size);
  volatile float kept = 0;
  const double seconds =
      least_time(1 + floats_moved / size, [&] { kept = HWY_DYNAMIC_DISPATCH(LoadAll)(from.get(), size); });
  return static_cast<double>(bytes) / seconds;
}

double store_bandwidth(std::size_t bytes) {
  const std::size_t size = bytes / sizeof(float);
  const auto to = ones(size);
  const double seconds = least_time(1 + floats_moved / size, [&] { HWY_DYNAMIC_DISPATCH(StoreAll)(to.get(), size); });
  return static_cast<double>(bytes) / seconds;
}

double packing_time(Packing packing, int arrays, std::size_t size, double share) {
  const std::size_t vectors = 2 * ((size + 2 * vector_length() - 1) / (2 * vector_length()));  // whole pairs
  const std::size_t stride = (vectors * vector_length() + gap + 15) / 16 * 16;
  const auto from = ones(stride * static_cast<std::size_t>(arrays));
  const auto to = ones(stride * static_cast<std::size_t>(arrays));
  std::vector<std::uint8_t> bits(8 * vectors);
  std::mt19937 draw(1);
  for (std::size_t lane = 0; lane < vectors * vector_length(); ++lane)
    if (static_cast<double>(draw()) < share * 0x1p32)
      bits[lane / vector_length() * 8 + lane % vector_length() / 8] |= static_cast<std::uint8_t>(1U << lane % 8);
  volatile std::size_t kept = 0;
  const double seconds = least_time(1 + floats_moved / 8 / size, [&] {
    kept = HWY_DYNAMIC_DISPATCH(Pack)(packing, arrays, from.get(), to.get(), vectors * vector_length(), stride,
                                      bits.data());
  });
  return seconds / static_cast<double>(vectors);
}

std::size_t vector_length() { return HWY_DYNAMIC_DISPATCH(VectorLength)(); }

const char* instructions() { return HWY_DYNAMIC_DISPATCH(Instructions)(); }

}  // namespace detp::benchmarks
#endif
