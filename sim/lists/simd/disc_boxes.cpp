#include "disc_boxes.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detp/sim/lists/simd/disc_boxes.cpp"
#include <hwy/foreach_target.h>
// highway.h must come after foreach_target.h.
#include <hwy/highway.h>

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace detp::sim::stream {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

FloatBox BoxAround(std::span<const FloatDisc> discs) {
  FloatBox box = nothing;
  for (const FloatDisc& disc : discs)
    for (int axis = 0; axis < 3; ++axis) {
      const float u = disc.normal[(axis + 1) % 3];
      const float v = disc.normal[(axis + 2) % 3];
      const float reach = disc.radius * std::sqrt(u * u + v * v);
      box.low[axis] = std::min(box.low[axis], disc.centre[axis] - reach);
      box.high[axis] = std::max(box.high[axis], disc.centre[axis] + reach);
    }
  return box;
}

#else

namespace hn = hwy::HWY_NAMESPACE;

/// One disc at a time, with an axis in each lane. The fourth lane is not used.
FloatBox BoxAround(std::span<const FloatDisc> discs) {
  const hn::FixedTag<float, 4> lanes;
  static constexpr std::int32_t after[4] = {1, 2, 0, 3};
  static constexpr std::int32_t before[4] = {2, 0, 1, 3};
  const auto next = hn::SetTableIndices(lanes, after);
  const auto last = hn::SetTableIndices(lanes, before);
  auto low = hn::Set(lanes, nothing.low[0]);
  auto high = hn::Set(lanes, nothing.high[0]);
  for (const FloatDisc& disc : discs) {
    const auto centre = hn::Load(lanes, disc.centre);
    const auto normal = hn::LoadU(lanes, disc.normal);
    const auto squares = hn::Mul(normal, normal);
    const auto sums = hn::Add(hn::TableLookupLanes(squares, next), hn::TableLookupLanes(squares, last));
    const auto reach = hn::Mul(hn::Set(lanes, disc.radius), hn::Sqrt(sums));
    low = hn::Min(low, hn::Sub(centre, reach));
    high = hn::Max(high, hn::Add(centre, reach));
  }
  alignas(16) float lows[4];
  alignas(16) float highs[4];
  hn::Store(low, lanes, lows);
  hn::Store(high, lanes, highs);
  return {{lows[0], lows[1], lows[2]}, {highs[0], highs[1], highs[2]}};
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace detp::sim::stream
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace detp::sim::stream {

HWY_EXPORT(BoxAround);

FloatBox box_around(std::span<const FloatDisc> discs) { return HWY_DYNAMIC_DISPATCH(BoxAround)(discs); }

}  // namespace detp::sim::stream
#endif
