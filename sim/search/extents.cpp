#include "extents.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detp/sim/search/extents.cpp"
#include <hwy/foreach_target.h>
// highway.h must come after foreach_target.h.
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "detp/sim/base/transpose-inl.hpp"
#include "soundness.hpp"

HWY_BEFORE_NAMESPACE();
namespace detp::sim {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A vector has at most as many lanes as an item has doubles; these are 2ⁱ.
template <class Item>
using LanesOf = hn::CappedTag<double, sizeof(Item) < 8 * sizeof(double) ? 4 : 8>;

HWY_INLINE const double* first_double(const Disc* disc) { return &disc->centre.x; }
HWY_INLINE const double* first_double(const Ray* ray) { return &ray->origin.x; }

/// Calls visit(fields) for all items, n at a time: double j of each is in fields[j]. The last item is repeated to fill the vectors.
template <class Item, class Visit>
HWY_INLINE void for_each_vector(std::span<const Item> items, const Visit& visit) {
  using Lanes = LanesOf<Item>;
  constexpr std::size_t n = hn::MaxLanes(Lanes());
  constexpr std::size_t size = sizeof(Item) / sizeof(double);
  const auto load = [&](const Item* first) {
    hn::Vec<Lanes> fields[size];
    for (std::size_t j = 0; j < size; j += n) {
      const std::size_t column = std::min(j, size - n);  // some columns of discs are loaded twice
      transpose<size>(Lanes(), first_double(first) + column, fields + column);
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
template <class Doubles>
HWY_INLINE Doubles square(const Doubles* vector) {
  return hn::Add(hn::Add(hn::Mul(vector[0], vector[0]), hn::Mul(vector[1], vector[1])), hn::Mul(vector[2], vector[2]));
}

/// surely_in_range and surely_unit of the first three doubles and of the next three.
template <class Lanes>
HWY_INLINE hn::Mask<Lanes> sound_vectors(Lanes lanes, const hn::Vec<Lanes>* fields) {
  const auto off = hn::Abs(hn::Sub(square(fields + 3), hn::Set(lanes, 1.0)));
  return hn::And(hn::Le(square(fields), hn::Set(lanes, largest_coordinate * largest_coordinate)),
                 hn::Le(off, hn::Set(lanes, unit_tolerance)));
}

// Highway's MinOfLanes and MaxOfLanes lose infinite numbers on EMU128.
template <class Lanes>
HWY_INLINE double least(Lanes lanes, hn::Vec<Lanes> values) {
  HWY_ALIGN double all[hn::MaxLanes(lanes)];
  hn::Store(values, lanes, all);
  return *std::min_element(std::begin(all), std::end(all));
}
template <class Lanes>
HWY_INLINE double most(Lanes lanes, hn::Vec<Lanes> values) {
  HWY_ALIGN double all[hn::MaxLanes(lanes)];
  hn::Store(values, lanes, all);
  return *std::max_element(std::begin(all), std::end(all));
}

DiscExtent DiscExtentOf(std::span<const Disc> discs) {
  using Lanes = LanesOf<Disc>;
  using Doubles = hn::Vec<Lanes>;
  using Mask = hn::Mask<Lanes>;
  const Lanes lanes;
  Doubles low[3];
  Doubles high[3];
  std::fill_n(low, 3, hn::Set(lanes, unbounded));
  std::fill_n(high, 3, hn::Set(lanes, -unbounded));
  Doubles smallest = hn::Set(lanes, unbounded);
  Doubles largest = hn::Zero(lanes);
  Mask sound = hn::FirstN(lanes, hn::MaxLanes(lanes));
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
    sound = hn::And(sound, hn::And(sound_vectors(lanes, fields), radii));
  });
  return {.centres = {{least(lanes, low[0]), least(lanes, low[1]), least(lanes, low[2])},
                      {most(lanes, high[0]), most(lanes, high[1]), most(lanes, high[2])}},
          .smallest = least(lanes, smallest),
          .largest = most(lanes, largest),
          .sound = hn::AllTrue(lanes, sound)};
}

RayExtent RayExtentOf(std::span<const Ray> rays, const glm::dvec3& centre, double power_limit) {
  using Lanes = LanesOf<Ray>;
  using Doubles = hn::Vec<Lanes>;
  using Mask = hn::Mask<Lanes>;
  const Lanes lanes;
  const Doubles from[3] = {hn::Set(lanes, centre.x), hn::Set(lanes, centre.y), hn::Set(lanes, centre.z)};
  Doubles farthest2 = hn::Zero(lanes);
  Doubles least_power = hn::Set(lanes, unbounded);
  Doubles most_power = hn::Zero(lanes);
  Doubles least_length = hn::Set(lanes, unbounded);
  Mask sound = hn::FirstN(lanes, hn::MaxLanes(lanes));
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
    sound = hn::And(hn::And(sound, sound_vectors(lanes, fields)), hn::And(lengths, powers));
  });
  return {.farthest2 = most(lanes, farthest2),
          .least_power = least(lanes, least_power),
          .most_power = most(lanes, most_power),
          .least_length = least(lanes, least_length),
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
