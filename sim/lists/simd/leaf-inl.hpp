// Included once for each instruction set (Highway's foreach_target), so no #pragma once.
#if defined(DETP_SIM_STREAM_LEAF_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DETP_SIM_STREAM_LEAF_INL_HPP
#undef DETP_SIM_STREAM_LEAF_INL_HPP
#else
#define DETP_SIM_STREAM_LEAF_INL_HPP
#endif

#include <bit>

#include <hwy/cache_control.h>

#include "block_search.hpp"
#include "detp/sim/geometry/predicates.hpp"
#include "detp/sim/search/sort_pairs.hpp"
#include "kernels-inl.hpp"

/// Tests lists of rays against the discs of a leaf: decides exactly which rays hit, and records the hits.
HWY_BEFORE_NAMESPACE();
namespace detp::sim::stream {
namespace HWY_NAMESPACE {

/// Decides the `unsure` lanes, which floats could not decide, with the canonical predicate. Returns the lanes that hit.
HWY_NOINLINE inline Mask decide_again(const BlockSearch& block, const Disc& disc, const std::uint32_t* ids, Mask unsure,
                                      Worker& worker) {
  const FloatLanes lanes;
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(lanes, unsure, bytes);
  worker.counts.doubtful += hn::CountTrue(lanes, unsure);
  for (std::size_t i = 0; i < hn::Lanes(lanes); ++i) {
    if ((bytes[i / 8] >> i % 8 & 1) == 0) continue;
    const Ray& ray = block.problem.rays()[block.first_ray + (ids[i] & ~falling)];
    const bool hit = hits(ray, disc) && (!block.problem.front_facing() || arrives_in_front(ray, disc));
    if (!hit) bytes[i / 8] = static_cast<std::uint8_t>(bytes[i / 8] & ~(1U << i % 8));
  }
  return hn::LoadMaskBits(lanes, bytes);
}

/// The lanes of `there` that hit the disc at that place.
template <bool segments, bool front_facing, int k>
HWY_INLINE Mask test(const BlockSearch& block, const RayVector<segments>& rays, Mask there, std::uint32_t place,
                     const SpreadDisc<k>& disc, Worker& worker) {
  const FloatLanes lanes;
  const auto decision = decide<segments, front_facing>(rays, disc);
  const Mask unsure = hn::And(decision.unsure, there);
  const Mask sure = hn::And(decision.sure, there);
  if (HWY_LIKELY(hn::AllFalse(lanes, unsure))) return sure;
  return hn::Or(sure, decide_again(block, block.problem.discs()[block.tree.order[place]], rays.id, unsure, worker));
}

/// For rays that all have the same power: it is enough to count hits.
template <bool segments, int k>
HWY_INLINE void count_hits(const BlockSearch& block, const TreeNode& leaf, const RayList& rays, Worker& worker) {
  const FloatLanes lanes;
  if (rays.size == 0) return;
  for (std::uint32_t place = leaf.first; place < leaf.first + leaf.count; ++place) {
    const SpreadDisc<k> disc(block.tree.discs[place]);
    std::size_t count = 0;
    for (std::size_t i = 0; i < rays.size; i += hn::Lanes(lanes)) {
      const RayVector<segments> vector(rays, i);
      count +=
          hn::CountTrue(lanes, test<segments, false, k>(block, vector, in_list(i, rays.size), place, disc, worker));
    }
    block.hits[place][k] += static_cast<std::uint32_t>(count);
  }
}

/// Rays that hit a disc, by their numbers in the block, in rising order.
struct FoundRays {
  const std::uint32_t* first;
  const std::uint32_t* last;
};

/// Writes the rays of one class that hit the disc to `found`, and up to `padding` numbers beyond their end. Branches only
/// for doubtful rays: whether a vector has a hit cannot be foreseen.
template <bool segments, bool front_facing, int k>
HWY_INLINE FoundRays find_hits(const BlockSearch& block, std::uint32_t place, const RayList& rays, std::uint32_t* found,
                               Worker& worker) {
  const FloatLanes lanes;
  const WordLanes words;
  const std::uint32_t* const first = found;
  const SpreadDisc<k> disc(block.tree.discs[place]);
  for (std::size_t i = 0; i < rays.size; i += hn::Lanes(lanes)) {
    const RayVector<segments> vector(rays, i);
    const Mask hit = test<segments, front_facing, k>(block, vector, in_list(i, rays.size), place, disc, worker);
    const auto kept = hn::IndicesFromVec(words, kept_lanes(lanes, hit));
    const auto ids = hn::AndNot(hn::Set(words, falling), hn::Load(words, vector.id));
    hn::StoreU(hn::TableLookupLanes(ids, kept), words, found);
    found += hn::CountTrue(lanes, hit);
  }
  return {first, found};
}

/// Makes room for all of a disc's hits by so many rays, and a mark behind those of each class.
HWY_INLINE std::uint32_t* room_for_hits(std::size_t rays, Worker& worker) {
  const std::size_t room = rays + classes + 2 * padding;
  if (worker.found.size() < room) worker.found.resize(room);
  return worker.found.data();
}

/// Adds the powers in `count` further bands, from one on, in ray order.
template <std::size_t count>
HWY_INLINE void add_bands(const FurtherSums& further, std::size_t band, const FoundRays& rays, double* row) {
  double sums[count];
  std::copy_n(row + band, count, sums);
  for (const std::uint32_t* ray = rays.first; ray != rays.last; ++ray) {
    const double* const powers = further.powers + *ray * further.bands + band;
    for (std::size_t i = 0; i < count; ++i) sums[i] += powers[i];
  }
  std::copy_n(sums, count, row + band);
}

/// Asks for the rays' rows of powers, which may be anywhere in memory.
HWY_NOINLINE inline void fetch_further_powers(const FurtherSums& further, const FoundRays& rays) {
  constexpr std::size_t in_line = 8;
  for (const std::uint32_t* ray = rays.first; ray != rays.last; ++ray)
    for (std::size_t band = 0; band < further.bands; band += in_line)
      hwy::Prefetch(further.powers + *ray * further.bands + band);
}

/// What add_powers does in band 0, in all others.
HWY_NOINLINE inline void add_further_powers(const BlockSearch& block, std::uint32_t place, std::size_t k,
                                            const FoundRays& rays) {
  if (rays.first == rays.last) return;
  const FurtherSums& further = block.further;
  double* const row = further.row(place, k);
  std::size_t band = 0;
  for (; band + 8 <= further.bands; band += 8) add_bands<8>(further, band, rays, row);
  for (; band + 2 <= further.bands; band += 2) add_bands<2>(further, band, rays, row);
  for (; band < further.bands; ++band) add_bands<1>(further, band, rays, row);
  if (block.photons == nullptr || block.problem.numbered()) return;
  for (band = 0; band < further.bands; ++band) {
    PhotonSums& photons = further.photons_of(place, band);
    const double unit = further.units[band];
    double& squares = photons.squares[static_cast<int>(k)];
    for (const std::uint32_t* ray = rays.first; ray != rays.last; ++ray) {
      const double one = further.powers[*ray * further.bands + band];
      squares += (unit * one) * (unit * one);
      photons.largest = std::max(photons.largest, one);
    }
    photons.add_photons(static_cast<std::uint64_t>(rays.last - rays.first));
  }
}

/// Adds the powers of one class's rays that hit the disc, in ray order; and their squares, if each ray is a photon.
HWY_INLINE void add_powers(const BlockSearch& block, std::uint32_t place, std::size_t k, const FoundRays& rays) {
  const auto axis = static_cast<int>(k);
  block.hits[place][k] += static_cast<std::uint32_t>(rays.last - rays.first);
  double power = block.totals[place].power[axis];
  if (block.photons == nullptr || block.problem.numbered()) {
    for (const std::uint32_t* ray = rays.first; ray != rays.last; ++ray) power += block.powers[*ray];
  } else {
    PhotonSums& photons = block.photons[place];
    double squares = photons.squares[axis];
    double largest = photons.largest;
    for (const std::uint32_t* ray = rays.first; ray != rays.last; ++ray) {
      const double one = block.powers[*ray];
      power += one;
      squares += (block.unit * one) * (block.unit * one);
      largest = std::max(largest, one);
    }
    photons.squares[axis] = squares;
    photons.largest = largest;
    photons.add_photons(static_cast<std::uint64_t>(rays.last - rays.first));
  }
  block.totals[place].power[axis] = power;
  if (HWY_UNLIKELY(block.further.bands != 0)) add_further_powers(block, place, k, rays);
}

HWY_INLINE void keep_pairs(const BlockSearch& block, std::uint32_t place, const FoundRays& rays, Worker& worker) {
  if (!block.pairs) return;
  for (const std::uint32_t* ray = rays.first; ray != rays.last; ++ray)
    add_pair(worker.pairs, {block.first_ray + *ray, block.tree.order[place]});
}

/// Adds a disc's hits to the sums of its photons, if these have several rays: merges the three classes in ray order, and does
/// what PhotonSums::add does, without branches that cannot be foreseen. The last photon stays under way, for it may have rays in
/// the next block. UINT32_MAX must follow the rays of each class. `powers` of the block's rays are `stride` apart.
HWY_NOINLINE inline void add_photons(const BlockSearch& block, const double* powers, std::size_t stride, double unit,
                                     PhotonSums& sums, const std::array<FoundRays, classes>& found) {
  const std::uint64_t* const photons = block.problem.photons().data() + block.first_ray;
  const std::uint32_t* next_x = found[0].first;
  const std::uint32_t* next_y = found[1].first;
  const std::uint32_t* next_z = found[2].first;
  double squares_x = sums.squares.x;
  double squares_y = sums.squares.y;
  double squares_z = sums.squares.z;
  double largest = sums.largest;
  double open = sums.open;
  std::uint64_t photon = sums.photon;
  std::uint64_t complete = 0;
  std::uint32_t axis = photon == PhotonSums::no_photon ? 3 : sums.axis;
  // Masks and opaque() keep the compiler from making branches of it.
  constexpr std::uint64_t all = ~std::uint64_t{0};
  static constexpr std::uint64_t masks[4][3] = {{all, 0, 0}, {0, all, 0}, {0, 0, all}, {0, 0, 0}};
  const auto opaque = [](std::uint32_t value) {
    asm("" : "+r"(value));
    return value;
  };
  const auto close = [&] {
    const double scaled = unit * open;
    const auto square = std::bit_cast<std::uint64_t>(scaled * scaled);
    squares_x += std::bit_cast<double>(square & masks[axis][0]);
    squares_y += std::bit_cast<double>(square & masks[axis][1]);
    squares_z += std::bit_cast<double>(square & masks[axis][2]);
    largest = std::max(largest, open);
  };
  while (true) {
    const std::uint32_t x = *next_x;
    const std::uint32_t y = *next_y;
    const std::uint32_t z = *next_z;
    const std::uint32_t ray = opaque(std::min(x, opaque(std::min(y, z))));
    if (HWY_UNLIKELY(ray == UINT32_MAX)) break;
    next_x += x == ray ? 1 : 0;
    next_y += y == ray ? 1 : 0;
    next_z += z == ray ? 1 : 0;
    if (HWY_LIKELY(photons[ray] != photon)) {
      close();
      complete += axis != 3 ? 1 : 0;
      photon = photons[ray];
      axis = (y == ray ? 1U : 0U) + (z == ray ? 2U : 0U);
      open = 0;
    }
    open += powers[ray * stride];
  }
  sums.squares = {squares_x, squares_y, squares_z};
  sums.largest = largest;
  sums.add_photons(complete);
  sums.open = open;
  sums.photon = photon;
  sums.axis = axis;
}

template <bool segments, bool front_facing, int k>
HWY_INLINE void sum_hits(const BlockSearch& block, const TreeNode& leaf, const RayList& rays, Worker& worker) {
  std::uint32_t* const room = room_for_hits((block.further.bands == 0 ? 1 : 2) * rays.size, worker);
  if (HWY_LIKELY(block.further.bands == 0)) {
    for (std::uint32_t place = leaf.first; place < leaf.first + leaf.count; ++place) {
      const FoundRays found = find_hits<segments, front_facing, k>(block, place, rays, room, worker);
      add_powers(block, place, k, found);
      keep_pairs(block, place, found, worker);
    }
    return;
  }
  // While the powers for one disc come from memory, the next is tested.
  FoundRays before{};
  for (std::uint32_t place = leaf.first; place < leaf.first + leaf.count; ++place) {
    std::uint32_t* const start = before.first == room ? room + rays.size + padding : room;
    const FoundRays found = find_hits<segments, front_facing, k>(block, place, rays, start, worker);
    fetch_further_powers(block.further, found);
    if (place > leaf.first) add_powers(block, place - 1, k, before);
    keep_pairs(block, place, found, worker);
    before = found;
  }
  add_powers(block, leaf.first + leaf.count - 1, k, before);
}

template <bool segments, bool counting_only, int k>
HWY_INLINE void test_class(const BlockSearch& block, const TreeNode& leaf, const RayList& rays, Worker& worker) {
  if constexpr (counting_only)
    count_hits<segments, k>(block, leaf, rays, worker);
  else if (block.problem.front_facing())
    sum_hits<segments, true, k>(block, leaf, rays, worker);
  else
    sum_hits<segments, false, k>(block, leaf, rays, worker);
}

/// Tests each disc with the rays of all classes, as sums over photons with several rays need.
template <bool segments, bool front_facing>
HWY_INLINE void test_all(const BlockSearch& block, const TreeNode& leaf, const RayLists& lists, Worker& worker) {
  std::uint32_t* const room = room_for_hits(size(lists), worker);
  for (std::uint32_t place = leaf.first; place < leaf.first + leaf.count; ++place) {
    std::array<FoundRays, classes> found;
    std::uint32_t* end = room;
    const auto keep = [&](std::size_t k, const FoundRays& rays) {
      found[k] = rays;
      end += rays.last - rays.first;
      *end++ = UINT32_MAX;
      add_powers(block, place, k, rays);
      keep_pairs(block, place, rays, worker);
    };
    keep(0, find_hits<segments, front_facing, 0>(block, place, lists[0], end, worker));
    keep(1, find_hits<segments, front_facing, 1>(block, place, lists[1], end, worker));
    keep(2, find_hits<segments, front_facing, 2>(block, place, lists[2], end, worker));
    if (end - room <= classes || !needs_all_classes(block)) continue;
    add_photons(block, block.powers, 1, block.unit, block.photons[place], found);
    const FurtherSums& further = block.further;
    for (std::size_t band = 0; band < further.bands; ++band)
      add_photons(block, further.powers + band, further.bands, further.units[band], further.photons_of(place, band),
                  found);
  }
  worker.counts.visits += leaf.count;
  worker.counts.disc_tests += leaf.count * size(lists);
}

template <bool segments>
HWY_INLINE void test_all(const BlockSearch& block, const TreeNode& leaf, const RayLists& lists, Worker& worker) {
  block.problem.front_facing() ? test_all<segments, true>(block, leaf, lists, worker)
                               : test_all<segments, false>(block, leaf, lists, worker);
}

template <bool segments, bool counting_only>
HWY_INLINE void test_leaf(const BlockSearch& block, const TreeNode& leaf, const RayLists& lists, Worker& worker) {
  if constexpr (!counting_only)
    if (needs_all_classes(block)) return test_all<segments>(block, leaf, lists, worker);
  test_class<segments, counting_only, 0>(block, leaf, lists[0], worker);
  test_class<segments, counting_only, 1>(block, leaf, lists[1], worker);
  test_class<segments, counting_only, 2>(block, leaf, lists[2], worker);
  worker.counts.visits += leaf.count;
  worker.counts.disc_tests += leaf.count * size(lists);
}

}  // namespace HWY_NAMESPACE
}  // namespace detp::sim::stream
HWY_AFTER_NAMESPACE();

#endif
