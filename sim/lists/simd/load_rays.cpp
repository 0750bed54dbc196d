#include "ray_blocks.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detp/sim/lists/simd/load_rays.cpp"
#include <hwy/foreach_target.h>
// highway.h must come after foreach_target.h.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#include "detp/sim/base/transpose-inl.hpp"
#include "kept_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace detp::sim::stream {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using DoubleLanes = hn::CappedTag<double, 8>;
using Doubles = hn::Vec<DoubleLanes>;
using Mask = hn::Mask<DoubleLanes>;

/// Vectors of doubles whose results are put into one vector of floats: two, if that has up to eight lanes. So the arrays of the lists
/// are written half as often.
constexpr std::size_t parts = hn::MaxLanes(DoubleLanes()) > 1 && hn::MaxLanes(DoubleLanes()) <= 4 ? 2 : 1;
constexpr std::size_t rays_in_part = hn::MaxLanes(DoubleLanes());
constexpr std::size_t rays_at_once = parts * rays_in_part;

using PartFloats = hn::Rebind<float, DoubleLanes>;
using PartWords = hn::Rebind<std::uint32_t, DoubleLanes>;
using FloatLanes = hn::CappedTag<float, rays_at_once>;
using WordLanes = hn::CappedTag<std::uint32_t, rays_at_once>;

/// Rays with |p| or |q| above this are left out. If a ray meets the ball of radius 1 around the origin, |p| and |q| are
/// at most √2. The rest is a margin for the slack.
constexpr double outside = 2;

/// Three coordinates of one vector of rays.
struct Triple {
  Doubles x, y, z;
};

/// For each ray the component along axis (k + shift) % 3. k is the ray's class: 0 in `first`, 1 in `second`, else 2.
HWY_INLINE Doubles turned(const Triple& v, Mask first, Mask second, int shift) {
  const Doubles axes[3] = {v.x, v.y, v.z};
  const Doubles of_third = axes[(2 + shift) % 3];
  return hn::IfThenElse(first, axes[shift % 3], hn::IfThenElse(second, axes[(1 + shift) % 3], of_third));
}

/// The rays of one vector of doubles before they are sorted into classes.
struct Part {
  hn::Vec<PartFloats> a, b, p, q, from, to;
  hn::Vec<PartWords> id;
  std::array<unsigned, classes> near;  ///< for each class, a bit for each of its rays that may meet S₀
};

HWY_INLINE unsigned bits_of(Mask mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(DoubleLanes(), mask, bits);
  return bits[0];
}

/// The parts of a vector of floats or words.
template <class Lanes, class Half>
HWY_INLINE hn::Vec<Lanes> joined([[maybe_unused]] Lanes lanes, Half first, [[maybe_unused]] Half second) {
#if HWY_TARGET == HWY_SCALAR
  return first;
#else
  if constexpr (parts == 1)
    return first;
  else
    return hn::Combine(lanes, second, first);
#endif
}

/// Appends the rays that `near` has a bit for.
template <bool ends>
HWY_INLINE void append(const Part& first, const Part& second, unsigned near, RayList& list) {
  const FloatLanes floats;
  const WordLanes words;
  const auto numbers = kept_lanes(floats, static_cast<std::uint8_t>(near));
  const auto places = hn::IndicesFromVec(floats, numbers);
  const std::size_t end = list.size;
  const auto write = [&](hn::Vec<PartFloats> low, hn::Vec<PartFloats> high, float* array) {
    hn::StoreU(hn::TableLookupLanes(joined(floats, low, high), places), floats, array + end);
  };
  write(first.a, second.a, list.a);
  write(first.b, second.b, list.b);
  write(first.p, second.p, list.p);
  write(first.q, second.q, list.q);
  if constexpr (ends) {
    write(first.from, second.from, list.from);
    write(first.to, second.to, list.to);
  }
  hn::StoreU(hn::TableLookupLanes(joined(words, first.id, second.id), hn::IndicesFromVec(words, numbers)), words,
             list.id + end);
  list.size = end + static_cast<std::size_t>(std::popcount(near));
}

/// Number of doubles in a Ray.
constexpr std::size_t doubles_in_ray = sizeof(Ray) / sizeof(double);
constexpr std::size_t direction_at = offsetof(Ray, direction) / sizeof(double);
constexpr std::size_t length_at = offsetof(Ray, length) / sizeof(double);
constexpr std::size_t power_at = offsetof(Ray, power) / sizeof(double);
static_assert(doubles_in_ray == 8);

/// Loads the fields of one vector of rays.
HWY_INLINE void load_fields(const Ray* rays, Doubles* fields) {
  for (std::size_t first = 0; first < doubles_in_ray; first += rays_in_part)
    sim::HWY_NAMESPACE::transpose<doubles_in_ray>(DoubleLanes(), &rays->origin.x + first, fields + first);
}

constexpr std::size_t prefetch_distance = 64;  ///< number of rays to prefetch

/// Lanes in which at least one ray so far is bounded, or has another power than the first ray.
struct RayProperties {
  Mask bounded;
  Mask other_power;
};

/// Loads one vector of rays, of which the first `count` are valid.
template <bool ends>
HWY_INLINE Part load_part(const Ray* rays, std::size_t count, std::uint32_t number, const Frame& frame, Doubles power,
                          RayProperties& properties) {
  const DoubleLanes lanes;
  const PartWords words;
  Doubles fields[doubles_in_ray];
  load_fields(rays, fields);
  const Triple direction{fields[direction_at], fields[direction_at + 1], fields[direction_at + 2]};
  const auto place = [&](std::size_t axis) {
    const Doubles centre = hn::Set(lanes, frame.centre[static_cast<int>(axis)]);
    return hn::Mul(hn::Sub(fields[axis], centre), hn::Set(lanes, frame.scale));
  };
  const Triple origin{place(0), place(1), place(2)};
  [[maybe_unused]] const Doubles length = fields[length_at];

  const Doubles dx = hn::Abs(direction.x);
  const Doubles dy = hn::Abs(direction.y);
  const Doubles dz = hn::Abs(direction.z);
  const Mask there = hn::FirstN(lanes, count);
  const Mask first = hn::And(hn::Ge(dx, dy), hn::Ge(dx, dz));
  const Mask second = hn::AndNot(first, hn::Ge(dy, dz));

  const Doubles z = turned(direction, first, second, 0);
  const Doubles start = turned(origin, first, second, 0);
  const Doubles inverse = hn::Div(hn::Set(lanes, 1.0), z);
  const Doubles a = hn::Mul(turned(direction, first, second, 1), inverse);
  const Doubles b = hn::Mul(turned(direction, first, second, 2), inverse);
  const Doubles p = hn::Sub(turned(origin, first, second, 1), hn::Mul(a, start));
  const Doubles q = hn::Sub(turned(origin, first, second, 2), hn::Mul(b, start));

  const PartFloats floats;
  const Doubles reach = hn::Set(lanes, outside);
  Mask near = hn::And(there, hn::Le(hn::Max(hn::Abs(p), hn::Abs(q)), reach));
  Part part;
  part.a = hn::DemoteTo(floats, a);
  part.b = hn::DemoteTo(floats, b);
  part.p = hn::DemoteTo(floats, p);
  part.q = hn::DemoteTo(floats, q);
  part.from = part.to = hn::Zero(floats);
  part.id = hn::Add(hn::Set(words, number), hn::Iota(words, 0));
  if constexpr (ends) {
    const Mask bounded = hn::Lt(length, hn::Set(lanes, unbounded));
    const Doubles end = hn::Add(start, hn::Mul(hn::Mul(length, hn::Set(lanes, frame.scale)), z));
    const Doubles far = hn::Set(lanes, 2 * outside);
    const Doubles from = hn::IfThenElse(bounded, hn::Max(hn::Min(start, end), hn::Neg(far)), hn::Neg(far));
    const Doubles to = hn::IfThenElse(bounded, hn::Min(hn::Max(start, end), far), far);
    near = hn::And(near, hn::And(hn::Le(from, reach), hn::Ge(to, hn::Neg(reach))));
    part.from = hn::DemoteTo(floats, from);
    part.to = hn::DemoteTo(floats, to);
    properties.bounded = hn::Or(properties.bounded, hn::And(there, bounded));
  }
  part.near = {bits_of(hn::And(near, first)), bits_of(hn::And(near, second)),
               bits_of(hn::AndNot(hn::Or(first, second), near))};
  // The sign of z, which is the direction's largest component and so not 0.
  part.id = hn::Or(part.id, hn::And(hn::BitCast(words, hn::DemoteTo(floats, z)), hn::Set(words, falling)));

  properties.other_power = hn::Or(properties.other_power, hn::And(there, hn::Ne(fields[power_at], power)));
  return part;
}

/// Loads `rays_at_once` rays, of which the first `count` are valid.
template <bool ends>
HWY_INLINE void load_some(const Ray* rays, std::size_t count, std::uint32_t number, const Frame& frame, Doubles power,
                          RayLists& lists, RayProperties& properties) {
  const Part first = load_part<ends>(rays, std::min(count, rays_in_part), number, frame, power, properties);
  if constexpr (parts == 1) {
    for (std::size_t k = 0; k < classes; ++k) append<ends>(first, first, first.near[k], lists[k]);
  } else {
    const Part second = load_part<ends>(rays + rays_in_part, count - std::min(count, rays_in_part),
                                        number + static_cast<std::uint32_t>(rays_in_part), frame, power, properties);
    for (std::size_t k = 0; k < classes; ++k)
      append<ends>(first, second, first.near[k] | second.near[k] << rays_in_part, lists[k]);
  }
}

template <bool ends>
RayTraits load(std::span<const Ray> rays, const Frame& given, RayLists& filled, std::uint32_t first_number) {
  // Local copies, so that the compiler can keep them in registers: a vector store might otherwise alias data that is
  // passed by reference.
  const Frame frame = given;
  RayLists lists = filled;
  const DoubleLanes lanes;
  constexpr std::size_t step = rays_at_once;
  const Doubles power = hn::Set(lanes, rays.front().power);
  RayProperties properties{hn::FirstN(lanes, 0), hn::FirstN(lanes, 0)};
  std::size_t i = 0;
  for (; i + step <= rays.size(); i += step) {
    // Prefetches rays that come from memory. (Prefetching did not help for rays in the third-level cache.)
    for (std::size_t j = i + prefetch_distance; j < HWY_MIN(i + prefetch_distance + step, rays.size()); ++j)
      hwy::Prefetch(&rays[j]);
    load_some<ends>(&rays[i], step, first_number + static_cast<std::uint32_t>(i), frame, power, lists, properties);
  }
  if (i < rays.size()) {
    Ray last[8];
    std::copy(rays.begin() + static_cast<std::ptrdiff_t>(i), rays.end(), last);
    load_some<ends>(last, rays.size() - i, first_number + static_cast<std::uint32_t>(i), frame, power, lists,
                    properties);
  }
  filled = lists;
  const bool same = hn::AllFalse(lanes, properties.other_power);
  return {!hn::AllFalse(lanes, properties.bounded), same ? std::optional(rays.front().power) : std::nullopt};
}

RayTraits LoadRays(std::span<const Ray> rays, const Frame& frame, RayLists& lists, std::uint32_t first_number) {
  return lists[0].from != nullptr ? load<true>(rays, frame, lists, first_number)
                                  : load<false>(rays, frame, lists, first_number);
}

}  // namespace HWY_NAMESPACE
}  // namespace detp::sim::stream
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace detp::sim::stream {

HWY_EXPORT(LoadRays);

RayTraits load_rays(std::span<const Ray> rays, const Frame& frame, RayLists& lists, std::uint32_t first_number) {
  const RayTraits traits = HWY_DYNAMIC_DISPATCH(LoadRays)(rays, frame, lists, first_number);
  for (RayList& list : lists) clear_padding(list);
  return traits;
}

}  // namespace detp::sim::stream
#endif
