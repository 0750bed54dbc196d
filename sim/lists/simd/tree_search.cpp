#include "list_search.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detp/sim/lists/simd/tree_search.cpp"
#include <hwy/foreach_target.h>
// highway.h must come after foreach_target.h.
#include <hwy/highway.h>

#include "kernels-inl.hpp"
#include "leaf-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace detp::sim::stream {
namespace HWY_NAMESPACE {

template <bool segments>
HWY_INLINE RayLists cull(const BlockSearch& block, const TreeNode& node, const RayLists& around, Worker& worker) {
  const float margin = block.frame.margin;
  RayLists inside;
  const auto list = [&](std::size_t k) -> RayList& { return inside[k] = worker.lists.next(around[k].size, segments); };
  cull_box<segments, 0>(around[0], node, margin, list(0));
  worker.lists.keep(inside[0]);
  cull_box<segments, 1>(around[1], node, margin, list(1));
  worker.lists.keep(inside[1]);
  cull_box<segments, 2>(around[2], node, margin, list(2));
  worker.lists.keep(inside[2]);
  worker.counts.cull_tests += size(around);
  worker.counts.listed += size(inside);
  ++worker.counts.culls;
  if (block.vectors) worker.vectors.cull += vectors_of(around);
  return inside;
}

/// Tests a leaf's discs in portions, and checks for a stop request before each portion.
template <bool segments, bool counting_only>
void visit_leaf(const BlockSearch& block, TreeNode leaf, const RayLists& lists, Worker& worker) {
  if (size(lists) == 0) return;  // the root may be a leaf, with no ray near
  const auto at_once =
      static_cast<std::uint32_t>(std::max<std::size_t>(1, StopCheck::most_work * tests_a_unit / size(lists)));
  for (std::uint32_t left = leaf.count; left > 0; left -= leaf.count, leaf.first += leaf.count) {
    leaf.count = std::min(left, at_once) & 0x7fff'ffff;
    if (worker.check.requested_after(test_work(size(lists), leaf.count)))
      return worker.skipped.push_back({leaf.first, left});
    test_leaf<segments, counting_only>(block, leaf, lists, worker);
    if (block.vectors) worker.vectors.test += leaf.count * vectors_of(lists);
  }
}

template <bool segments, bool counting_only>
void visit(const BlockSearch& block, const TreeNode& node, const RayLists& lists, Worker& worker) {
  if (node.leaf) return visit_leaf<segments, counting_only>(block, node, lists, worker);
  for (std::uint32_t child = node.first; child < node.first + node.count; ++child) {
    const TreeNode& next = block.tree.nodes[child];
    if (worker.check.requested_after(test_work(size(lists)))) {
      worker.skipped.push_back(discs_below(block.tree, next));
      continue;
    }
    const ArenaScope scope(worker.lists);
    const RayLists inside = cull<segments>(block, next, lists, worker);
    if (size(inside) > 0) visit<segments, counting_only>(block, next, inside, worker);
  }
}

RayLists CullNode(const BlockSearch& block, const TreeNode& node, const RayLists& around, Worker& worker) {
  return block.segments ? cull<true>(block, node, around, worker) : cull<false>(block, node, around, worker);
}

void SearchBelow(const BlockSearch& block, const TreeNode& node, const RayLists& lists, Worker& worker) {
  if (block.totals == nullptr)
    block.segments ? visit<true, true>(block, node, lists, worker) : visit<false, true>(block, node, lists, worker);
  else
    block.segments ? visit<true, false>(block, node, lists, worker) : visit<false, false>(block, node, lists, worker);
}

const char* InstructionSet() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace detp::sim::stream
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace detp::sim::stream {

HWY_EXPORT(CullNode);
HWY_EXPORT(SearchBelow);
HWY_EXPORT(InstructionSet);

RayLists cull_node(const BlockSearch& block, const TreeNode& node, const RayLists& around, Worker& worker) {
  return HWY_DYNAMIC_DISPATCH(CullNode)(block, node, around, worker);
}

void search_below(const BlockSearch& block, const TreeNode& node, const RayLists& lists, Worker& worker) {
  HWY_DYNAMIC_DISPATCH(SearchBelow)(block, node, lists, worker);
}

const char* instruction_set() { return HWY_DYNAMIC_DISPATCH(InstructionSet)(); }

}  // namespace detp::sim::stream
#endif
