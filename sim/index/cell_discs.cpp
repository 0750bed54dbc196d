#include "cell_discs.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detp/sim/index/cell_discs.cpp"
#include <hwy/foreach_target.h>
// highway.h must come after foreach_target.h.
#include <hwy/highway.h>

#include <algorithm>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/lists/simd/kernels-inl.hpp"
#include "detp/sim/lists/simd/ray_blocks.hpp"

HWY_BEFORE_NAMESPACE();
namespace detp::sim {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using FloatLanes = hn::CappedTag<float, CellDiscs::padding>;
using Floats = hn::Vec<FloatLanes>;
constexpr std::size_t n = hn::MaxLanes(FloatLanes());
constexpr std::size_t floats_in_disc = sizeof(stream::FloatDisc) / sizeof(float);
static_assert(floats_in_disc == 8);

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE void load_fields(const float* rows, Floats* columns) {
  for (std::size_t j = 0; j < floats_in_disc; ++j) columns[j] = hn::Load(FloatLanes(), rows + j);
}
#else
/// Four floats of disc i and, with vectors of eight, of disc i + 4.
HWY_INLINE Floats load_halves(const float* rows) {
  const FloatLanes lanes;
  if constexpr (n == 4) {
    return hn::LoadU(lanes, rows);
  } else {
    const hn::Half<FloatLanes> half;
    return hn::Combine(lanes, hn::LoadU(half, rows + 4 * floats_in_disc), hn::LoadU(half, rows));
  }
}

/// Writes the fields of n discs: transposes blocks of four by four.
HWY_INLINE void load_fields(const float* rows, Floats* columns) {
  const FloatLanes lanes;
  const hn::Repartition<double, FloatLanes> pairs;
  for (std::size_t j = 0; j < floats_in_disc; j += 4) {
    const Floats one = load_halves(rows + j);
    const Floats two = load_halves(rows + j + floats_in_disc);
    const Floats three = load_halves(rows + j + 2 * floats_in_disc);
    const Floats four = load_halves(rows + j + 3 * floats_in_disc);
    const auto lower_of_two = hn::BitCast(pairs, hn::InterleaveLower(lanes, one, two));
    const auto upper_of_two = hn::BitCast(pairs, hn::InterleaveUpper(lanes, one, two));
    const auto lower_of_four = hn::BitCast(pairs, hn::InterleaveLower(lanes, three, four));
    const auto upper_of_four = hn::BitCast(pairs, hn::InterleaveUpper(lanes, three, four));
    columns[j] = hn::BitCast(lanes, hn::InterleaveLower(pairs, lower_of_two, lower_of_four));
    columns[j + 1] = hn::BitCast(lanes, hn::InterleaveUpper(pairs, lower_of_two, lower_of_four));
    columns[j + 2] = hn::BitCast(lanes, hn::InterleaveLower(pairs, upper_of_two, upper_of_four));
    columns[j + 3] = hn::BitCast(lanes, hn::InterleaveUpper(pairs, upper_of_two, upper_of_four));
  }
}
#endif

HWY_INLINE std::uint64_t bits_of(hn::Mask<FloatLanes> mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(FloatLanes(), mask, bits);
  return bits[0];
}

/// One ray in all lanes.
template <bool segments>
struct SpreadRay {
  using Lanes = FloatLanes;
  Floats a, b, p, q, from, to, sense;

  HWY_INLINE explicit SpreadRay(const FloatRay& ray) {
    const FloatLanes lanes;
    a = hn::Set(lanes, ray.line[0]);
    b = hn::Set(lanes, ray.line[1]);
    p = hn::Set(lanes, ray.line[2]);
    q = hn::Set(lanes, ray.line[3]);
    sense = hn::BitCast(lanes, hn::Set(hn::RebindToUnsigned<FloatLanes>(), ray.falling));
    if constexpr (segments) {
      from = hn::Set(lanes, ray.ends[0]);
      to = hn::Set(lanes, ray.ends[1]);
    }
  }

  [[nodiscard]] HWY_INLINE Floats falls() const { return sense; }
};

/// Several discs in the coordinates of class k.
template <int k>
struct DiscVector {
  Floats cx, cy, cz, nx, ny, nz, radius, band, ends;

  HWY_INLINE explicit DiscVector(const stream::FloatDisc* discs) {
    Floats fields[floats_in_disc];
    load_fields(discs->centre, fields);
    constexpr auto axes = stream::axes_of_class(k);
    cx = fields[axes[0]];
    cy = fields[axes[1]];
    cz = fields[axes[2]];
    nx = fields[3 + axes[0]];
    ny = fields[3 + axes[1]];
    nz = fields[3 + axes[2]];
    radius = fields[6];
    band = fields[7];
    ends = hn::Mul(hn::Set(FloatLanes(), 0.5F), band);
  }
};

template <bool segments, bool front_facing, int k>
CellDecision Decide(const FloatRay& ray, const stream::FloatDisc* discs, std::size_t count) {
  const SpreadRay<segments> rays(ray);
  CellDecision decision;
  for (std::size_t i = 0; i < count; i += n) {
    const auto decided = stream::HWY_NAMESPACE::decide<segments, front_facing>(rays, DiscVector<k>(discs + i));
    decision.sure |= bits_of(decided.sure) << i;
    decision.unsure |= bits_of(decided.unsure) << i;
  }
  const std::uint64_t there = ~std::uint64_t{0} >> (64 - count);
  return {decision.sure & there, decision.unsure & there};
}

template <bool segments, bool front_facing>
DecideCells decide_of() {
  return {Decide<segments, front_facing, 0>, Decide<segments, front_facing, 1>, Decide<segments, front_facing, 2>};
}

DecideCells DecideCellsFor(bool segments, bool front_facing) {
  if (segments) return front_facing ? decide_of<true, true>() : decide_of<true, false>();
  return front_facing ? decide_of<false, true>() : decide_of<false, false>();
}

}  // namespace HWY_NAMESPACE
}  // namespace detp::sim
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace detp::sim {

HWY_EXPORT(DecideCellsFor);

DecideCells decide_cells(bool segments, bool front_facing) {
  return HWY_DYNAMIC_DISPATCH(DecideCellsFor)(segments, front_facing);
}

void FloatRays::load(std::span<const Ray> rays, const stream::Frame& frame) {
  const stream::ArenaScope scope(arena_);
  stream::RayLists lists;
  for (stream::RayList& list : lists) list = arena_.allocate(rays.size(), true);
  stream::load_rays(rays, frame, lists);
  loaded_.assign(rays.size(), {});
  for (std::uint32_t axis = 0; axis < stream::classes; ++axis) {
    const stream::RayList& list = lists[axis];
    for (std::size_t i = 0; i < list.size; ++i)
      loaded_[list.id[i] & ~stream::falling] = {.line = {list.a[i], list.b[i], list.p[i], list.q[i]},
                                                .ends = {list.from[i], list.to[i]},
                                                .falling = list.id[i] & stream::falling,
                                                .axis = axis};
  }
}

CellDiscs::CellDiscs(const Problem& problem, std::span<const std::uint32_t> references, const std::stop_token& stop)
    : frame_(problem) {
  UnsetVector<std::uint32_t> order(references.begin(), references.end());
  order.resize(order.size() + padding, 0);  // any disc; its lanes are not used
  discs_ = stream::discs_in_order(problem, frame_, std::move(order), {.stop = stop}).discs;
}

}  // namespace detp::sim
#endif
