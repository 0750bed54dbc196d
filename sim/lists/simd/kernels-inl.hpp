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

/// One vector of rays of a list that is culled, and the lanes that are kept.
template <bool segments>
struct TestedRays {
  Floats a, b, p, q, from, to;
  Mask kept;
};

/// Appends to `to` the kept lanes of the vector at `first` of `list`.
///
/// The numbers of the kept lanes are found once. Each array is then permuted. (A Compress for each array would take five
/// cycles on Zen 5, and a table lookup without AVX-512.)
template <bool segments>
HWY_INLINE void append(const RayList& list, std::size_t first, const TestedRays<segments>& rays, RayList& to) {
  const FloatLanes lanes;
  const WordLanes words;
  const auto chosen = kept_lanes(lanes, rays.kept);
  const auto places = hn::IndicesFromVec(lanes, chosen);
  const std::size_t end = to.size;
  hn::StoreU(hn::TableLookupLanes(rays.a, places), lanes, to.a + end);
  hn::StoreU(hn::TableLookupLanes(rays.b, places), lanes, to.b + end);
  hn::StoreU(hn::TableLookupLanes(rays.p, places), lanes, to.p + end);
  hn::StoreU(hn::TableLookupLanes(rays.q, places), lanes, to.q + end);
  const auto ids = hn::Load(words, list.id + first);
  hn::StoreU(hn::TableLookupLanes(ids, hn::IndicesFromVec(words, chosen)), words, to.id + end);
  if constexpr (segments) {
    hn::StoreU(hn::TableLookupLanes(rays.from, places), lanes, to.from + end);
    hn::StoreU(hn::TableLookupLanes(rays.to, places), lanes, to.to + end);
  }
  to.size = end + hn::CountTrue(lanes, rays.kept);
}

#undef DETP_APPEND_TWO
#if HWY_TARGET <= HWY_AVX3
#define DETP_APPEND_TWO 1
#else
#define DETP_APPEND_TWO 0
#endif

#if DETP_APPEND_TWO

/// The same for two vectors, at `first` and behind it: mostly at most a vector's lanes are kept, so each array is permuted and stored
/// once. (Storing takes most of the time of culling.)
template <bool segments>
HWY_INLINE void append(const RayList& list, std::size_t first, const TestedRays<segments>& rays,
                       const TestedRays<segments>& more, RayList& to) {
  const FloatLanes lanes;
  const WordLanes words;
  const std::size_t count = hn::CountTrue(lanes, rays.kept);
  const std::size_t more_count = hn::CountTrue(lanes, more.kept);
  const auto numbers = hn::Iota(words, 0);
  const auto of_more = hn::Compress(hn::Iota(words, padding), hn::RebindMask(words, more.kept));
  const auto chosen = _mm512_mask_expand_epi32(hn::Compress(numbers, hn::RebindMask(words, rays.kept)).raw,
                                               static_cast<__mmask16>(0xffffU << count), of_more.raw);
  const auto store = [&](Floats x, Floats y, float* array)
                         HWY_ATTR { _mm512_storeu_ps(array + to.size, _mm512_permutex2var_ps(x.raw, chosen, y.raw)); };
  store(rays.a, more.a, to.a);
  store(rays.b, more.b, to.b);
  store(rays.p, more.p, to.p);
  store(rays.q, more.q, to.q);
  const auto more_ids = hn::Load(words, list.id + first + padding);
  _mm512_storeu_si512(to.id + to.size,
                      _mm512_permutex2var_epi32(hn::Load(words, list.id + first).raw, chosen, more_ids.raw));
  if constexpr (segments) {
    store(rays.from, more.from, to.from);
    store(rays.to, more.to, to.to);
  }
  if (HWY_UNLIKELY(count + more_count > padding)) {
    const std::size_t end = to.size + count;
    const auto places = hn::And(of_more, hn::Set(words, padding - 1));
    const auto store_more = [&](Floats y, float* array) HWY_ATTR {
      hn::StoreU(hn::TableLookupLanes(y, hn::IndicesFromVec(lanes, places)), lanes, array + end);
    };
    store_more(more.a, to.a);
    store_more(more.b, to.b);
    store_more(more.p, to.p);
    store_more(more.q, to.q);
    hn::StoreU(hn::TableLookupLanes(more_ids, hn::IndicesFromVec(words, places)), words, to.id + end);
    if constexpr (segments) {
      store_more(more.from, to.from);
      store_more(more.to, to.to);
    }
  }
  to.size += count + more_count;
}

#endif

/// Lists the rays of `rays` that `kept(rays)` has a lane for.
template <bool segments, class Kept>
HWY_INLINE void cull(const RayList& rays, RayList& inside, const Kept& kept) {
  const FloatLanes lanes;
  // Local copies, so that the compiler can keep them in registers: a vector store might otherwise alias the lists.
  const RayList around = rays;
  RayList to = inside;
  to.size = 0;
  const auto test = [&](std::size_t i) HWY_ATTR {
    TestedRays<segments> tested;
    tested.a = hn::Load(lanes, around.a + i);
    tested.b = hn::Load(lanes, around.b + i);
    tested.p = hn::Load(lanes, around.p + i);
    tested.q = hn::Load(lanes, around.q + i);
    if constexpr (segments) {
      tested.from = hn::Load(lanes, around.from + i);
      tested.to = hn::Load(lanes, around.to + i);
    }
    tested.kept = kept(tested);
    if (HWY_UNLIKELY(i + hn::Lanes(lanes) > around.size)) tested.kept = hn::And(tested.kept, in_list(i, around.size));
    return tested;
  };
  std::size_t i = 0;
#if DETP_APPEND_TWO
  for (; i + hn::Lanes(lanes) < around.size; i += 2 * hn::Lanes(lanes))
    append<segments>(around, i, test(i), test(i + hn::Lanes(lanes)), to);
#endif
  for (; i < around.size; i += hn::Lanes(lanes)) append<segments>(around, i, test(i), to);
  inside.size = to.size;
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
  cull<segments>(rays, inside, [&](const TestedRays<segments>& of) HWY_ATTR {
    const Floats off_x = hn::Abs(hn::Sub(hn::MulAdd(of.a, cz, of.p), cx));
    const Floats off_y = hn::Abs(hn::Sub(hn::MulAdd(of.b, cz, of.q), cy));
    Mask kept = hn::And(hn::Le(hn::NegMulAdd(hn::Abs(of.a), hz, off_x), hx),
                        hn::Le(hn::NegMulAdd(hn::Abs(of.b), hz, off_y), hy));
    if constexpr (segments) kept = hn::And(kept, hn::And(hn::Le(of.from, high), hn::Ge(of.to, low)));
    return kept;
  });
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
  cull<segments>(rays, inside, [&](const TestedRays<segments>& of) HWY_ATTR {
    const Floats P = hn::Sub(hn::MulAdd(of.a, cz, of.p), cx);
    const Floats Q = hn::Sub(hn::MulAdd(of.b, cz, of.q), cy);
    const Floats turn = hn::MulSub(P, of.b, hn::Mul(Q, of.a));
    const Floats moment = hn::MulAdd(P, P, hn::MulAdd(Q, Q, hn::Mul(turn, turn)));
    const Floats stretch = hn::MulAdd(of.a, of.a, hn::MulAdd(of.b, of.b, hn::Set(lanes, 1.0F)));
    Mask kept = hn::Le(moment, hn::Mul(square, stretch));
    if constexpr (segments) kept = hn::And(kept, hn::And(hn::Le(of.from, high), hn::Ge(of.to, low)));
    return kept;
  });
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
