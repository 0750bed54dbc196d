#include "search.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "disc_results.hpp"
#include "list_search.hpp"
#include "ray_blocks.hpp"

namespace detp::sim::stream {
namespace {

using Workers = tbb::enumerable_thread_specific<Worker>;

/// Searches everything below a node. Processes the children as tasks if there is enough work.
void divide(const BlockSearch& block, const TreeNode& node, const RayLists& lists, Workers& workers) {
  if (node.leaf || size(lists) < rays_to_divide) {
    search_below(block, node, lists, workers.local());
    return;
  }
  sim::parallel_for(node.first, node.first + node.count, [&](std::uint32_t child) {
    Worker& worker = workers.local();
    const TreeNode& next = block.tree.nodes[child];
    if (worker.check.requested_after(test_work(size(lists))))
      return worker.skipped.push_back(discs_below(block.tree, next));
    const ArenaScope scope(worker.lists);
    const RayLists inside = cull_node(block, next, lists, worker);
    if (size(inside) > 0) divide(block, next, inside, workers);
  });
}

}  // namespace

bool can_search(const Problem& problem) { return Frame(problem).slack <= 0.01; }

void search_boxes(const SearchInput& input, const RunOptions& options, Outcome& outcome) {
  const Problem& problem = input.problem;
  const Frame& frame = input.frame;
  const DiscTree& tree = input.tree;
  const SearchSize size = size_of(problem, options);
  const TreeSize made{static_cast<double>(tree.binary_nodes), static_cast<double>(tree.nodes.size()), tree.lists};
  add_checked_bytes("the tree of boxes and its lists of rays", boxes_bytes(size, made), problem, outcome);
  on_threads(thread_count(options.threads), [&] {
    Workers workers([&] {
      return Worker(options.memory, options.stop, list_rays(size, tree.lists), least_list_rays(size, tree.lists));
    });
    DiscResults results(problem, tree, options, outcome);
    for_each_block(problem, frame, options, [&](const Block& block) {
      divide(results.begin(frame, block), tree.nodes.front(), block.lists(), workers);
      results.end(block, workers);
    });
    results.store_results(workers);
  });
}

}  // namespace detp::sim::stream
