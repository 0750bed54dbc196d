#include "list_search.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detp/sim/lists/simd/list_search.cpp"
#include <hwy/foreach_target.h>
// highway.h must come after foreach_target.h.
#include <hwy/highway.h>

#include "kernels-inl.hpp"
#include "leaf-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace detp::sim::stream {
namespace HWY_NAMESPACE {

template <int k>
void cull_class(const BlockSearch& block, const FloatSphere& sphere, const RayList& around, RayList& inside) {
  block.segments ? cull_sphere<true, k>(around, sphere, inside) : cull_sphere<false, k>(around, sphere, inside);
}

void CullSphere(const BlockSearch& block, int k, const FloatSphere& sphere, const RayList& around, RayList& inside,
                Worker& worker) {
  if (block.vectors) worker.vectors.cull += vectors_of(around.size);
  if (k == 0) return cull_class<0>(block, sphere, around, inside);
  if (k == 1) return cull_class<1>(block, sphere, around, inside);
  return cull_class<2>(block, sphere, around, inside);
}

template <int k>
void test_any(const BlockSearch& block, const TreeNode& leaf, const RayList& rays, Worker& worker) {
  if (block.totals == nullptr)
    block.segments ? test_class<true, true, k>(block, leaf, rays, worker)
                   : test_class<false, true, k>(block, leaf, rays, worker);
  else
    block.segments ? test_class<true, false, k>(block, leaf, rays, worker)
                   : test_class<false, false, k>(block, leaf, rays, worker);
}

void TestDiscs(const BlockSearch& block, int k, std::uint32_t first, std::uint32_t count, const RayList& rays,
               Worker& worker) {
  const TreeNode leaf{.centre = {}, .half = {}, .first = first, .count = count & 0x7fff'ffff, .leaf = 1};
  if (block.vectors) worker.vectors.test += count * vectors_of(rays.size);
  if (k == 0) return test_any<0>(block, leaf, rays, worker);
  if (k == 1) return test_any<1>(block, leaf, rays, worker);
  return test_any<2>(block, leaf, rays, worker);
}

void TestAllClasses(const BlockSearch& block, std::uint32_t first, std::uint32_t count, const RayLists& lists,
                    Worker& worker) {
  const TreeNode leaf{.centre = {}, .half = {}, .first = first, .count = count & 0x7fff'ffff, .leaf = 1};
  if (block.vectors) worker.vectors.test += count * vectors_of(lists);
  block.segments ? test_all<true>(block, leaf, lists, worker) : test_all<false>(block, leaf, lists, worker);
}

std::ptrdiff_t number(const FoundRays& rays) { return rays.last - rays.first; }

template <bool segments, bool front_facing>
std::span<const std::uint32_t> find_all(const BlockSearch& block, std::uint32_t place, const RayLists& lists,
                                        Worker& worker) {
  std::uint32_t* const room = room_for_hits(size(lists), worker);
  std::uint32_t* end = room;
  end += number(find_hits<segments, front_facing, 0>(block, place, lists[0], end, worker));
  end += number(find_hits<segments, front_facing, 1>(block, place, lists[1], end, worker));
  end += number(find_hits<segments, front_facing, 2>(block, place, lists[2], end, worker));
  return {room, end};
}

std::span<const std::uint32_t> FindRays(const BlockSearch& block, std::uint32_t place, const RayLists& lists,
                                        Worker& worker) {
  const bool front_facing = block.problem.front_facing();
  if (block.segments)
    return front_facing ? find_all<true, true>(block, place, lists, worker)
                        : find_all<true, false>(block, place, lists, worker);
  return front_facing ? find_all<false, true>(block, place, lists, worker)
                      : find_all<false, false>(block, place, lists, worker);
}

}  // namespace HWY_NAMESPACE
}  // namespace detp::sim::stream
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace detp::sim::stream {

HWY_EXPORT(CullSphere);
HWY_EXPORT(TestDiscs);
HWY_EXPORT(TestAllClasses);
HWY_EXPORT(FindRays);

void cull_sphere(const BlockSearch& block, int k, const FloatSphere& sphere, const RayList& around, RayList& inside,
                 Worker& worker) {
  HWY_DYNAMIC_DISPATCH(CullSphere)(block, k, sphere, around, inside, worker);
}

void test_discs(const BlockSearch& block, int k, std::uint32_t first, std::uint32_t count, const RayList& rays,
                Worker& worker) {
  HWY_DYNAMIC_DISPATCH(TestDiscs)(block, k, first, count, rays, worker);
}

void test_all_classes(const BlockSearch& block, std::uint32_t first, std::uint32_t count, const RayLists& lists,
                      Worker& worker) {
  HWY_DYNAMIC_DISPATCH(TestAllClasses)(block, first, count, lists, worker);
}

std::span<const std::uint32_t> find_rays(const BlockSearch& block, std::uint32_t place, const RayLists& lists,
                                         Worker& worker) {
  return HWY_DYNAMIC_DISPATCH(FindRays)(block, place, lists, worker);
}

}  // namespace detp::sim::stream
#endif
