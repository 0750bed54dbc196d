// Included once for each instruction set (Highway's foreach_target), so no #pragma once.
#if defined(DETP_SIM_STREAM_LEAF_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef DETP_SIM_STREAM_LEAF_INL_HPP
#undef DETP_SIM_STREAM_LEAF_INL_HPP
#else
#define DETP_SIM_STREAM_LEAF_INL_HPP
#endif

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
                     Worker& worker) {
  const FloatLanes lanes;
  const SpreadDisc<k> disc(block.tree.discs[place]);
  const Decision decision = decide<segments, front_facing>(rays, disc);
  const Mask unsure = hn::And(decision.unsure, there);
  const Mask sure = hn::And(decision.sure, there);
  if (HWY_LIKELY(hn::AllFalse(lanes, unsure))) return sure;
  return hn::Or(sure, decide_again(block, block.problem.discs()[block.tree.order[place]], rays.id, unsure, worker));
}

/// For rays that all have the same power: it is enough to count hits.
template <bool segments, int k>
HWY_INLINE void count_hits(const BlockSearch& block, const TreeNode& leaf, const RayList& rays, Worker& worker) {
  const FloatLanes lanes;
  for (std::size_t i = 0; i < rays.size; i += hn::Lanes(lanes)) {
    const RayVector<segments> vector(rays, i);
    const Mask there = in_list(i, rays.size);
    for (std::uint32_t place = leaf.first; place < leaf.first + leaf.count; ++place)
      block.hits[place][k] += static_cast<std::uint32_t>(
          hn::CountTrue(lanes, test<segments, false, k>(block, vector, there, place, worker)));
  }
}

/// Adds up the powers of the rays that hit, in ray order, and records pairs.
HWY_INLINE void keep_hits(const BlockSearch& block, Mask hit, const std::uint32_t* ids, std::uint32_t place, int k,
                          Worker& worker) {
  const FloatLanes lanes;
  const WordLanes words;
  if (hn::AllFalse(lanes, hit)) return;
  HWY_ALIGN std::uint32_t found[padding] = {};
  const auto places = hn::IndicesFromVec(words, kept_lanes(lanes, hit));
  hn::StoreU(hn::TableLookupLanes(hn::Load(words, ids), places), words, found);
  const std::size_t count = hn::CountTrue(lanes, hit);
  const Ray* const first = block.problem.rays().data() + block.first_ray;
  DiscTotals& totals = block.totals[place];
  block.hits[place][static_cast<std::size_t>(k)] += static_cast<std::uint32_t>(count);
  for (std::size_t i = 0; i < count; ++i) totals.power[k] += first[found[i] & ~falling].power;
  if (!block.pairs) return;
  for (std::size_t i = 0; i < count; ++i)
    add_pair(worker.pairs, {block.first_ray + (found[i] & ~falling), block.tree.order[place]});
}

template <bool segments, bool front_facing, int k>
HWY_INLINE void gather_hits(const BlockSearch& block, const TreeNode& leaf, const RayList& rays, Worker& worker) {
  const FloatLanes lanes;
  for (std::size_t i = 0; i < rays.size; i += hn::Lanes(lanes)) {
    const RayVector<segments> vector(rays, i);
    const Mask there = in_list(i, rays.size);
    for (std::uint32_t place = leaf.first; place < leaf.first + leaf.count; ++place)
      keep_hits(block, test<segments, front_facing, k>(block, vector, there, place, worker), vector.id, place, k,
                worker);
  }
}

template <bool segments, bool counting_only, int k>
HWY_INLINE void test_class(const BlockSearch& block, const TreeNode& leaf, const RayList& rays, Worker& worker) {
  if constexpr (counting_only)
    count_hits<segments, k>(block, leaf, rays, worker);
  else if (block.problem.front_facing())
    gather_hits<segments, true, k>(block, leaf, rays, worker);
  else
    gather_hits<segments, false, k>(block, leaf, rays, worker);
}

template <bool segments, bool counting_only>
HWY_INLINE void test_leaf(const BlockSearch& block, const TreeNode& leaf, const RayLists& lists, Worker& worker) {
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
