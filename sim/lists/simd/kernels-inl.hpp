// Included once for each instruction set (Highway's foreach_target), so no #pragma once.
#if defined(DETP_SIM_STREAM_KERNELS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DETP_SIM_STREAM_KERNELS_INL_HPP
#undef DETP_SIM_STREAM_KERNELS_INL_HPP
#else
#define DETP_SIM_STREAM_KERNELS_INL_HPP
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "disc_tree.hpp"
#include "kept_lanes-inl.hpp"
#include "ray_list.hpp"

/// The inner loops: a list of rays of one class against one box, one sphere, one disc.
HWY_BEFORE_NAMESPACE();
namespace detp::sim::stream {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using FloatLanes = hn::CappedTag<float, padding>;
using WordLanes = hn::CappedTag<std::uint32_t, padding>;
using Floats = hn::Vec<FloatLanes>;
using Mask = hn::Mask<FloatLanes>;

/// Number of vectors that hold `rays` rays.
HWY_INLINE std::size_t vectors_of(std::size_t rays) {
  const FloatLanes lanes;
  return (rays + hn::Lanes(lanes) - 1) / hn::Lanes(lanes);
}

/// Number of vectors that hold the lists of all classes.
HWY_INLINE std::size_t vectors_of(const RayLists& lists) {
  return vectors_of(lists[0].size) + vectors_of(lists[1].size) + vectors_of(lists[2].size);
}

/// The lanes of the vector at `first` that are in a list of `size` rays.
HWY_INLINE Mask in_list(std::size_t first, std::size_t size) {
  const FloatLanes lanes;
  return hn::FirstN(lanes, HWY_MIN(size - first, hn::Lanes(lanes)));
}

/// Appends to `to` the kept lanes of the vector at `first` of `from`.
///
/// The numbers of the kept lanes are found once. Each array is then permuted. (A Compress for each array would take five
/// cycles on Zen 5, and a table lookup without AVX-512.)
template <bool segments>
HWY_INLINE void append(const RayList& from, std::size_t first, Floats a, Floats b, Floats p, Floats q, Mask kept,
                       RayList& to) {
  const FloatLanes lanes;
  const WordLanes words;
  const auto chosen = kept_lanes(lanes, kept);
  const auto places = hn::IndicesFromVec(lanes, chosen);
  const std::size_t end = to.size;
  hn::StoreU(hn::TableLookupLanes(a, places), lanes, to.a + end);
  hn::StoreU(hn::TableLookupLanes(b, places), lanes, to.b + end);
  hn::StoreU(hn::TableLookupLanes(p, places), lanes, to.p + end);
  hn::StoreU(hn::TableLookupLanes(q, places), lanes, to.q + end);
  const auto ids = hn::Load(words, from.id + first);
  hn::StoreU(hn::TableLookupLanes(ids, hn::IndicesFromVec(words, chosen)), words, to.id + end);
  if constexpr (segments) {
    hn::StoreU(hn::TableLookupLanes(hn::Load(lanes, from.from + first), places), lanes, to.from + end);
    hn::StoreU(hn::TableLookupLanes(hn::Load(lanes, from.to + first), places), lanes, to.to + end);
  }
  to.size = end + hn::CountTrue(lanes, kept);
}

/// Lists all rays that cross the box grown by `margin`, and some that miss it.
///
/// Let c be the box's centre and h half its sides. A ray x = p + a z is in the box's slabs of x and z at once only if
/// |p + a c_z - c_x| <= h_x + |a| h_z. The same holds for y. (A test of the third separating axis, z × D, would
/// shorten lists by a tenth.)
template <bool segments, int k>
HWY_INLINE void cull_box(const RayList& rays, const TreeNode& box, float margin, RayList& inside) {
  const FloatLanes lanes;
  constexpr auto axes = axes_of_class(k);
  constexpr int x = axes[0];
  constexpr int y = axes[1];
  constexpr int z = axes[2];
  const Floats cx = hn::Set(lanes, box.centre[x]);
  const Floats cy = hn::Set(lanes, box.centre[y]);
  const Floats cz = hn::Set(lanes, box.centre[z]);
  const Floats hx = hn::Set(lanes, box.half[x] + margin);
  const Floats hy = hn::Set(lanes, box.half[y] + margin);
  const Floats hz = hn::Set(lanes, box.half[z] + margin);
  [[maybe_unused]] const Floats low = hn::Set(lanes, box.centre[z] - (box.half[z] + margin));
  [[maybe_unused]] const Floats high = hn::Set(lanes, box.centre[z] + (box.half[z] + margin));
  // Local copies, so that the compiler can keep them in registers: a vector store might otherwise alias the lists.
  const RayList around = rays;
  RayList kept_rays = inside;
  kept_rays.size = 0;
  for (std::size_t i = 0; i < around.size; i += hn::Lanes(lanes)) {
    const Floats a = hn::Load(lanes, around.a + i);
    const Floats b = hn::Load(lanes, around.b + i);
    const Floats p = hn::Load(lanes, around.p + i);
    const Floats q = hn::Load(lanes, around.q + i);
    const Floats off_x = hn::Abs(hn::Sub(hn::MulAdd(a, cz, p), cx));
    const Floats off_y = hn::Abs(hn::Sub(hn::MulAdd(b, cz, q), cy));
    Mask kept =
        hn::And(hn::Le(hn::NegMulAdd(hn::Abs(a), hz, off_x), hx), hn::Le(hn::NegMulAdd(hn::Abs(b), hz, off_y), hy));
    if constexpr (segments) {
      kept = hn::And(
          kept, hn::And(hn::Le(hn::Load(lanes, around.from + i), high), hn::Ge(hn::Load(lanes, around.to + i), low)));
    }
    if (HWY_UNLIKELY(i + hn::Lanes(lanes) > around.size)) kept = hn::And(kept, in_list(i, around.size));
    append<segments>(around, i, a, b, p, q, kept, kept_rays);
  }
  inside.size = kept_rays.size;
}

/// Lists the rays that may come within the sphere, whose radius already includes Frame::margin.
///
/// With w = (P, Q, 0) from the sphere's centre to the ray at the centre's z, and D = (a, b, 1), the ray's distance from
/// the centre is |w × D|/|D|.
/// Segments are additionally clipped against the sphere's extent in z. A segment that ends before the sphere, in a
/// corner of the sphere's bounding box, is listed although it misses the sphere.
template <bool segments, int k>
HWY_INLINE void cull_sphere(const RayList& rays, const FloatSphere& sphere, RayList& inside) {
  const FloatLanes lanes;
  constexpr auto axes = axes_of_class(k);
  const Floats cx = hn::Set(lanes, sphere.centre[axes[0]]);
  const Floats cy = hn::Set(lanes, sphere.centre[axes[1]]);
  const Floats cz = hn::Set(lanes, sphere.centre[axes[2]]);
  const Floats square = hn::Set(lanes, sphere.radius * sphere.radius);
  [[maybe_unused]] const Floats low = hn::Set(lanes, sphere.centre[axes[2]] - sphere.radius);
  [[maybe_unused]] const Floats high = hn::Set(lanes, sphere.centre[axes[2]] + sphere.radius);
  // Local copies, so that the compiler can keep them in registers: a vector store might otherwise alias the lists.
  const RayList around = rays;
  RayList kept_rays = inside;
  kept_rays.size = 0;
  for (std::size_t i = 0; i < around.size; i += hn::Lanes(lanes)) {
    const Floats a = hn::Load(lanes, around.a + i);
    const Floats b = hn::Load(lanes, around.b + i);
    const Floats p = hn::Load(lanes, around.p + i);
    const Floats q = hn::Load(lanes, around.q + i);
    const Floats P = hn::Sub(hn::MulAdd(a, cz, p), cx);
    const Floats Q = hn::Sub(hn::MulAdd(b, cz, q), cy);
    const Floats turn = hn::MulSub(P, b, hn::Mul(Q, a));
    const Floats moment = hn::MulAdd(P, P, hn::MulAdd(Q, Q, hn::Mul(turn, turn)));
    const Floats stretch = hn::MulAdd(a, a, hn::MulAdd(b, b, hn::Set(lanes, 1.0F)));
    Mask kept = hn::Le(moment, hn::Mul(square, stretch));
    if constexpr (segments) {
      kept = hn::And(
          kept, hn::And(hn::Le(hn::Load(lanes, around.from + i), high), hn::Ge(hn::Load(lanes, around.to + i), low)));
    }
    if (HWY_UNLIKELY(i + hn::Lanes(lanes) > around.size)) kept = hn::And(kept, in_list(i, around.size));
    append<segments>(around, i, a, b, p, q, kept, kept_rays);
  }
  inside.size = kept_rays.size;
}

/// The lanes that certainly hit a disc, and the lanes that possibly do.
template <class Lanes>
struct Decision {
  hn::Mask<Lanes> sure;
  hn::Mask<Lanes> unsure;
};

/// A disc in the coordinates of class k; each number is broadcast to all lanes.
template <int k>
struct SpreadDisc {
  Floats cx, cy, cz, nx, ny, nz, radius, band, ends;

  HWY_INLINE explicit SpreadDisc(const FloatDisc& disc) {
    const FloatLanes lanes;
    constexpr auto axes = axes_of_class(k);
    constexpr int x = axes[0];
    constexpr int y = axes[1];
    constexpr int z = axes[2];
    cx = hn::Set(lanes, disc.centre[x]);
    cy = hn::Set(lanes, disc.centre[y]);
    cz = hn::Set(lanes, disc.centre[z]);
    nx = hn::Set(lanes, disc.normal[x]);
    ny = hn::Set(lanes, disc.normal[y]);
    nz = hn::Set(lanes, disc.normal[z]);
    radius = hn::Set(lanes, disc.radius);
    band = hn::Set(lanes, disc.band);
    ends = hn::Set(lanes, 0.5F * disc.band);
  }
};

/// One vector of rays of a list.
template <bool segments>
struct RayVector {
  using Lanes = FloatLanes;
  Floats a, b, p, q, from, to;
  const std::uint32_t* id;

  /// The sign bits are set of rays that go towards smaller z.
  [[nodiscard]] HWY_INLINE Floats falls() const { return hn::BitCast(FloatLanes(), hn::Load(WordLanes(), id)); }

  HWY_INLINE RayVector(const RayList& list, std::size_t first) : id(list.id + first) {
    const FloatLanes lanes;
    a = hn::Load(lanes, list.a + first);
    b = hn::Load(lanes, list.b + first);
    p = hn::Load(lanes, list.p + first);
    q = hn::Load(lanes, list.q + first);
    if constexpr (segments) {
      from = hn::Load(lanes, list.from + first);
      to = hn::Load(lanes, list.to + first);
    }
  }
};

/// The canonical decision (predicates.hpp) in floats, if it is certain.
///
/// Let c be the disc's centre, n its normal and d its radius. With w = (P, Q, 0) from c to the ray at z = c_z,
/// D = (a, b, 1), φ = n·D and g = n·w, the crossing is at (wφ - Dg)/φ from c. The ray hits if |wφ - Dg| <= d|φ| and,
/// for segments, from <= c_z - g/φ <= to. The decision is uncertain within `band` of the rim or within `ends` of an end
/// (sim/lists/simd/floats.md).
///
/// `rays` and `disc` are like RayVector and SpreadDisc: several rays and one disc, or one ray and several discs.
template <bool segments, bool front_facing, class Rays, class Discs>
HWY_INLINE Decision<typename Rays::Lanes> decide(const Rays& rays, const Discs& disc) {
  const typename Rays::Lanes lanes;
  const auto a = rays.a;
  const auto b = rays.b;
  const auto P = hn::Sub(hn::MulAdd(a, disc.cz, rays.p), disc.cx);
  const auto Q = hn::Sub(hn::MulAdd(b, disc.cz, rays.q), disc.cy);
  const auto facing = hn::MulAdd(disc.nx, a, hn::MulAdd(disc.ny, b, disc.nz));
  const auto height = hn::MulAdd(disc.nx, P, hn::Mul(disc.ny, Q));
  const auto X = hn::NegMulAdd(a, height, hn::Mul(P, facing));
  const auto Y = hn::NegMulAdd(b, height, hn::Mul(Q, facing));
  const auto square = hn::MulAdd(X, X, hn::MulAdd(Y, Y, hn::Mul(height, height)));
  const auto size = hn::Abs(facing);
  const auto outer = hn::MulAdd(disc.radius, size, disc.band);
  const auto inner = hn::Max(hn::MulSub(disc.radius, size, disc.band), hn::Zero(lanes));
  auto sure = hn::Lt(square, hn::Mul(inner, inner));
  auto possible = hn::Le(square, hn::Mul(outer, outer));
  if constexpr (segments) {
    // -g sgn φ, which must lie between (from - c_z)|φ| and (to - c_z)|φ|.
    const auto along = hn::Xor(hn::Neg(height), hn::And(facing, hn::SignBit(lanes)));
    const auto after = hn::NegMulAdd(hn::Sub(rays.from, disc.cz), size, along);
    const auto before = hn::MulSub(hn::Sub(rays.to, disc.cz), size, along);
    const auto within = hn::Min(after, before);
    sure = hn::And(sure, hn::Gt(within, disc.ends));
    possible = hn::And(possible, hn::Ge(within, hn::Neg(disc.ends)));
  }
  if constexpr (front_facing) {
    // The direction has the sense of (a, b, 1), or of -(a, b, 1) if the top bit of the id is set. The ray arrives in
    // front if the dot product of its direction and the normal is negative.
    const auto in_front = hn::Lt(hn::Xor(facing, hn::And(rays.falls(), hn::SignBit(lanes))), hn::Zero(lanes));
    // If a hit is certain, so is its face. Uncertain hits are decided again anyway.
    possible = hn::And(possible, hn::Or(in_front, hn::Not(sure)));
    sure = hn::And(sure, in_front);
  }
  return {sure, hn::AndNot(sure, possible)};
}

}  // namespace HWY_NAMESPACE
}  // namespace detp::sim::stream
HWY_AFTER_NAMESPACE();

#endif
