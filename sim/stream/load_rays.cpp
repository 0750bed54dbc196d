#include "load_rays.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detp/sim/stream/load_rays.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace detp::sim::stream {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using DoubleLanes = hn::CappedTag<double, 8>;
using NumberLanes = hn::Rebind<std::int64_t, DoubleLanes>;
using FloatLanes = hn::Rebind<float, DoubleLanes>;
using WordLanes = hn::Rebind<std::uint32_t, DoubleLanes>;
using Doubles = hn::Vec<DoubleLanes>;
using Mask = hn::Mask<DoubleLanes>;

/// Beyond the ball around the origin of radius 1, with room for the slack: |p| and |q| of a ray that meets it are no
/// more than √2.
constexpr double outside = 2;

/// Three coordinates of as many rays as there are lanes.
struct Triple {
  Doubles x, y, z;
};

/// For each ray the component along the axis k + shift, k its class (first: class 0; second: class 1).
HWY_INLINE Doubles turned(const Triple& v, Mask first, Mask second, int shift) {
  const Doubles axes[3] = {v.x, v.y, v.z};
  const Doubles of_third = axes[(2 + shift) % 3];
  return hn::IfThenElse(first, axes[shift % 3], hn::IfThenElse(second, axes[(1 + shift) % 3], of_third));
}

/// As many rays as there are lanes, before they are sorted into classes.
struct Lines {
  Doubles a, b, p, q, from, to;
  hn::Vec<WordLanes> id;
  Mask near;

  HWY_INLINE void append(Mask chosen, RayList& list) const {
    const FloatLanes floats;
    const WordLanes words;
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(DoubleLanes(), hn::And(chosen, near), bits);
    const auto kept = hn::LoadMaskBits(floats, bits);
    const std::size_t end = list.size;
    hn::StoreU(hn::Compress(hn::DemoteTo(floats, a), kept), floats, list.a + end);
    hn::StoreU(hn::Compress(hn::DemoteTo(floats, b), kept), floats, list.b + end);
    hn::StoreU(hn::Compress(hn::DemoteTo(floats, p), kept), floats, list.p + end);
    hn::StoreU(hn::Compress(hn::DemoteTo(floats, q), kept), floats, list.q + end);
    hn::StoreU(hn::Compress(hn::DemoteTo(floats, from), kept), floats, list.from + end);
    hn::StoreU(hn::Compress(hn::DemoteTo(floats, to), kept), floats, list.to + end);
    hn::StoreU(hn::Compress(id, hn::RebindMask(words, kept)), words, list.id + end);
    list.size = end + hn::CountTrue(floats, kept);
  }
};

/// One field, `offset` doubles into a Ray, of as many rays as there are lanes.
HWY_INLINE Doubles field(const Ray* rays, std::size_t offset) {
  const NumberLanes numbers;
  constexpr auto stride = static_cast<std::int64_t>(sizeof(Ray) / sizeof(double));
  const auto places = hn::Mul(hn::Iota(numbers, 0), hn::Set(numbers, stride));
  return hn::GatherIndex(DoubleLanes(), &rays->origin.x + offset, places);
}

constexpr std::size_t offset_of_direction = offsetof(Ray, direction) / sizeof(double);
constexpr std::size_t offset_of_length = offsetof(Ray, length) / sizeof(double);
constexpr std::size_t offset_of_power = offsetof(Ray, power) / sizeof(double);

constexpr std::size_t ahead = 64;  ///< rays that memory is asked for before they are needed

/// What the rays have in common, so far.
struct Seen {
  Mask bounded;
  Mask other_power;
};

/// Loads as many rays as there are lanes, the first `count` of which count.
HWY_INLINE void load_some(const Ray* rays, std::size_t count, std::uint32_t number, const Frame& frame, Doubles power,
                          RayLists& lists, Seen& seen) {
  const DoubleLanes lanes;
  const WordLanes words;
  const Triple direction{field(rays, offset_of_direction), field(rays, offset_of_direction + 1),
                         field(rays, offset_of_direction + 2)};
  const auto place = [&](std::size_t axis) {
    const Doubles centre = hn::Set(lanes, frame.centre[static_cast<int>(axis)]);
    return hn::Mul(hn::Sub(field(rays, axis), centre), hn::Set(lanes, frame.scale));
  };
  const Triple origin{place(0), place(1), place(2)};
  const Doubles length = field(rays, offset_of_length);

  const Doubles dx = hn::Abs(direction.x);
  const Doubles dy = hn::Abs(direction.y);
  const Doubles dz = hn::Abs(direction.z);
  const Mask there = hn::FirstN(lanes, count);
  const Mask first = hn::And(hn::Ge(dx, dy), hn::Ge(dx, dz));
  const Mask second = hn::AndNot(first, hn::Ge(dy, dz));

  Lines lines;
  const Doubles z = turned(direction, first, second, 0);
  const Doubles start = turned(origin, first, second, 0);
  const Doubles inverse = hn::Div(hn::Set(lanes, 1.0), z);
  lines.a = hn::Mul(turned(direction, first, second, 1), inverse);
  lines.b = hn::Mul(turned(direction, first, second, 2), inverse);
  lines.p = hn::Sub(turned(origin, first, second, 1), hn::Mul(lines.a, start));
  lines.q = hn::Sub(turned(origin, first, second, 2), hn::Mul(lines.b, start));

  const Mask bounded = hn::Lt(length, hn::Set(lanes, unbounded));
  const Doubles end = hn::Add(start, hn::Mul(hn::Mul(length, hn::Set(lanes, frame.scale)), z));
  const Doubles far = hn::Set(lanes, 2 * outside);
  lines.from = hn::IfThenElse(bounded, hn::Max(hn::Min(start, end), hn::Neg(far)), hn::Neg(far));
  lines.to = hn::IfThenElse(bounded, hn::Min(hn::Max(start, end), far), far);

  const Doubles reach = hn::Set(lanes, outside);
  lines.near = hn::And(hn::And(there, hn::Le(hn::Max(hn::Abs(lines.p), hn::Abs(lines.q)), reach)),
                       hn::And(hn::Le(lines.from, reach), hn::Ge(lines.to, hn::Neg(reach))));
  std::uint8_t falls[8] = {};
  hn::StoreMaskBits(lanes, hn::Lt(z, hn::Zero(lanes)), falls);
  lines.id = hn::Add(hn::Set(words, number), hn::Iota(words, 0));
  lines.id = hn::Or(lines.id, hn::IfThenElseZero(hn::LoadMaskBits(words, falls), hn::Set(words, falling)));
  lines.append(first, lists[0]);
  lines.append(second, lists[1]);
  lines.append(hn::Not(hn::Or(first, second)), lists[2]);

  seen.bounded = hn::Or(seen.bounded, hn::And(there, bounded));
  seen.other_power = hn::Or(seen.other_power, hn::And(there, hn::Ne(field(rays, offset_of_power), power)));
}

RayTraits LoadRays(std::span<const Ray> rays, const Frame& frame, RayLists& lists) {
  const DoubleLanes lanes;
  const std::size_t step = hn::Lanes(lanes);
  const Doubles power = hn::Set(lanes, rays.front().power);
  Seen seen{hn::FirstN(lanes, 0), hn::FirstN(lanes, 0)};
  std::size_t i = 0;
  for (; i + step <= rays.size(); i += step) {
    // Gathers do not teach the processor what comes next.
    for (std::size_t j = i + ahead; j < HWY_MIN(i + ahead + step, rays.size()); ++j) hwy::Prefetch(&rays[j]);
    load_some(&rays[i], step, static_cast<std::uint32_t>(i), frame, power, lists, seen);
  }
  if (i < rays.size()) {
    Ray last[8];
    std::copy(rays.begin() + static_cast<std::ptrdiff_t>(i), rays.end(), last);
    load_some(last, rays.size() - i, static_cast<std::uint32_t>(i), frame, power, lists, seen);
  }
  const bool same = hn::AllFalse(lanes, seen.other_power);
  return {!hn::AllFalse(lanes, seen.bounded), same ? std::optional(rays.front().power) : std::nullopt};
}

}  // namespace HWY_NAMESPACE
}  // namespace detp::sim::stream
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace detp::sim::stream {

HWY_EXPORT(LoadRays);

RayTraits load_rays(std::span<const Ray> rays, const Frame& frame, RayLists& lists) {
  return HWY_DYNAMIC_DISPATCH(LoadRays)(rays, frame, lists);
}

}  // namespace detp::sim::stream
#endif
