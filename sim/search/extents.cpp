#include "extents.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detp/sim/search/extents.cpp"
#include <hwy/foreach_target.h>
// highway.h must come after foreach_target.h.
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

#include "detp/sim/base/transpose-inl.hpp"
#include "soundness.hpp"

HWY_BEFORE_NAMESPACE();
namespace detp::sim {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using DoubleLanes = hn::CappedTag<double, 4>;
using Doubles = hn::Vec<DoubleLanes>;
using Mask = hn::Mask<DoubleLanes>;

constexpr std::size_t n = hn::MaxLanes(DoubleLanes());

HWY_INLINE const double* first_double(const Disc* disc) { return &disc->centre.x; }
HWY_INLINE const double* first_double(const Ray* ray) { return &ray->origin.x; }

/// Calls visit(fields) for all items, n at a time: double j of each is in fields[j]. The last item is repeated to fill the vectors.
template <class Item, class Visit>
HWY_INLINE void for_each_vector(std::span<const Item> items, const Visit& visit) {
  constexpr std::size_t size = sizeof(Item) / sizeof(double);
  const auto load = [&](const Item* first) {
    Doubles fields[size];
    for (std::size_t j = 0; j < size; j += n) {
      const std::size_t column = std::min(j, size - n);  // some columns of discs are loaded twice
      transpose<size>(DoubleLanes(), first_double(first) + column, fields + column);
    }
    visit(fields);
  };
  std::size_t i = 0;
  for (; i + n <= items.size(); i += n) load(&items[i]);
  if (i == items.size()) return;
  Item last[n];
  for (std::size_t j = 0; j < n; ++j) last[j] = items[std::min(i + j, items.size() - 1)];
  load(last);
}

/// Rounded like glm::dot.
HWY_INLINE Doubles square(const Doubles* vector) {
  return hn::Add(hn::Add(hn::Mul(vector[0], vector[0]), hn::Mul(vector[1], vector[1])), hn::Mul(vector[2], vector[2]));
}

/// surely_in_range and surely_unit of the first three doubles and of the next three.
HWY_INLINE Mask sound_vectors(const Doubles* fields) {
  const DoubleLanes lanes;
  const Doubles off = hn::Abs(hn::Sub(square(fields + 3), hn::Set(lanes, 1.0)));
  return hn::And(hn::Le(square(fields), hn::Set(lanes, largest_coordinate * largest_coordinate)),
                 hn::Le(off, hn::Set(lanes, unit_tolerance)));
}

// Highway's MinOfLanes and MaxOfLanes lose infinite numbers on EMU128.
HWY_INLINE double least(Doubles values) {
  HWY_ALIGN double all[n];
  hn::Store(values, DoubleLanes(), all);
  return *std::min_element(all, all + n);
}
HWY_INLINE double most(Doubles values) {
  HWY_ALIGN double all[n];
  hn::Store(values, DoubleLanes(), all);
  return *std::max_element(all, all + n);
}

DiscExtent DiscExtentOf(std::span<const Disc> discs) {
  const DoubleLanes lanes;
  Doubles low[3];
  Doubles high[3];
  std::fill_n(low, 3, hn::Set(lanes, unbounded));
  std::fill_n(high, 3, hn::Set(lanes, -unbounded));
  Doubles smallest = hn::Set(lanes, unbounded);
  Doubles largest = hn::Zero(lanes);
  Mask sound = hn::FirstN(lanes, n);
  for_each_vector(discs, [&](const Doubles* fields) {
    const Doubles radius = fields[6];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = hn::Min(low[axis], fields[axis]);
      high[axis] = hn::Max(high[axis], fields[axis]);
    }
    smallest = hn::Min(smallest, radius);
    largest = hn::Max(largest, radius);
    const Mask radii =
        hn::And(hn::Ge(radius, hn::Set(lanes, least_radius)), hn::Le(radius, hn::Set(lanes, largest_coordinate)));
    sound = hn::And(sound, hn::And(sound_vectors(fields), radii));
  });
  return {.centres = {{least(low[0]), least(low[1]), least(low[2])}, {most(high[0]), most(high[1]), most(high[2])}},
          .smallest = least(smallest),
          .largest = most(largest),
          .sound = hn::AllTrue(lanes, sound)};
}

RayExtent RayExtentOf(std::span<const Ray> rays, const glm::dvec3& centre, double power_limit) {
  const DoubleLanes lanes;
  const Doubles from[3] = {hn::Set(lanes, centre.x), hn::Set(lanes, centre.y), hn::Set(lanes, centre.z)};
  Doubles farthest2 = hn::Zero(lanes);
  Doubles least_power = hn::Set(lanes, unbounded);
  Doubles most_power = hn::Zero(lanes);
  Doubles least_length = hn::Set(lanes, unbounded);
  Mask sound = hn::FirstN(lanes, n);
  for_each_vector(rays, [&](const Doubles* fields) {
    const Doubles length = fields[6];
    const Doubles power = fields[7];
    const Doubles away[3] = {hn::Sub(fields[0], from[0]), hn::Sub(fields[1], from[1]), hn::Sub(fields[2], from[2])};
    farthest2 = hn::Max(farthest2, square(away));
    least_power = hn::Min(least_power, power);
    most_power = hn::Max(most_power, power);
    least_length = hn::Min(least_length, length);
    const Mask lengths = hn::Gt(length, hn::Zero(lanes));
    const Mask powers = hn::And(hn::Ge(power, hn::Zero(lanes)), hn::Le(power, hn::Set(lanes, power_limit)));
    sound = hn::And(hn::And(sound, sound_vectors(fields)), hn::And(lengths, powers));
  });
  return {.farthest2 = most(farthest2),
          .least_power = least(least_power),
          .most_power = most(most_power),
          .least_length = least(least_length),
          .sound = hn::AllTrue(lanes, sound)};
}

}  // namespace HWY_NAMESPACE
}  // namespace detp::sim
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace detp::sim {

HWY_EXPORT(DiscExtentOf);
HWY_EXPORT(RayExtentOf);

DiscExtent extent_of(std::span<const Disc> discs) { return HWY_DYNAMIC_DISPATCH(DiscExtentOf)(discs); }

RayExtent extent_of(std::span<const Ray> rays, const glm::dvec3& centre, double power_limit) {
  return HWY_DYNAMIC_DISPATCH(RayExtentOf)(rays, centre, power_limit);
}

DiscExtent joined(const DiscExtent& a, const DiscExtent& b) {
  return {.centres = {glm::min(a.centres.low, b.centres.low), glm::max(a.centres.high, b.centres.high)},
          .smallest = std::min(a.smallest, b.smallest),
          .largest = std::max(a.largest, b.largest),
          .sound = a.sound && b.sound};
}

RayExtent joined(const RayExtent& a, const RayExtent& b) {
  return {.farthest2 = std::max(a.farthest2, b.farthest2),
          .least_power = std::min(a.least_power, b.least_power),
          .most_power = std::max(a.most_power, b.most_power),
          .least_length = std::min(a.least_length, b.least_length),
          .sound = a.sound && b.sound};
}

}  // namespace detp::sim
#endif
