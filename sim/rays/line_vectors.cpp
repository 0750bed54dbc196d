#include "line_vectors.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detp/sim/rays/line_vectors.cpp"
#include <hwy/foreach_target.h>
// highway.h must come after foreach_target.h.
#include <hwy/highway.h>

#include "detp/sim/geometry/turn-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace detp::sim {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Up to as many lanes as a group of coordinates is aligned to. The operations of line_at, uniform_direction and basis_around.
void WriteLines(const Sphere& sphere, const LineCoordinates& coordinates, std::span<Ray> lines) {
  const hn::CappedTag<double, 8> lanes;
  const auto of = [lanes](double value) { return hn::Set(lanes, value); };
  const auto one = of(1);
  for (std::size_t first = 0; first < lines.size(); first += hn::Lanes(lanes)) {
    const auto load = [&](std::size_t j) { return hn::Load(lanes, &coordinates.of[j][first]); };
    const auto z = hn::Sub(one, hn::Mul(of(2), load(0)));
    const auto rho = hn::Sqrt(hn::Max(hn::Zero(lanes), hn::Sub(one, hn::Mul(z, z))));
    const auto around = turns(lanes, load(1));
    const auto x = hn::Mul(rho, around.cos);
    const auto y = hn::Mul(rho, around.sin);

    const auto sign = hn::CopySign(one, z);
    const auto a = hn::Div(of(-1), hn::Add(sign, z));
    const auto b = hn::Mul(hn::Mul(x, y), a);
    const auto first_x = hn::Add(one, hn::Mul(hn::Mul(hn::Mul(sign, x), x), a));
    const auto first_y = hn::Mul(sign, b);
    const auto first_z = hn::Mul(hn::Neg(sign), x);
    const auto second_y = hn::Add(sign, hn::Mul(hn::Mul(y, y), a));
    const auto second_z = hn::Neg(y);

    const auto radius = hn::Mul(of(sphere.radius), hn::Sqrt(load(2)));
    const auto place = turns(lanes, load(3));
    alignas(64) double fields[6][hn::MaxLanes(lanes)];
    const auto store_origin = [&](int axis, auto one_way, auto other_way) {
      const auto aside = hn::Add(hn::Mul(place.cos, one_way), hn::Mul(place.sin, other_way));
      hn::Store(hn::Add(of(sphere.centre[axis]), hn::Mul(radius, aside)), lanes, fields[axis]);
    };
    store_origin(0, first_x, b);
    store_origin(1, first_y, second_y);
    store_origin(2, first_z, second_z);
    hn::Store(x, lanes, fields[3]);
    hn::Store(y, lanes, fields[4]);
    hn::Store(z, lanes, fields[5]);
    const std::size_t count = HWY_MIN(hn::Lanes(lanes), lines.size() - first);
    for (std::size_t i = 0; i < count; ++i)
      lines[first + i] = {.origin = {fields[0][i], fields[1][i], fields[2][i]},
                          .direction = {fields[3][i], fields[4][i], fields[5][i]}};
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace detp::sim
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace detp::sim {

HWY_EXPORT(WriteLines);

void write_lines(const Sphere& sphere, const LineCoordinates& coordinates, std::span<Ray> lines) {
  HWY_DYNAMIC_DISPATCH(WriteLines)(sphere, coordinates, lines);
}

}  // namespace detp::sim
#endif
