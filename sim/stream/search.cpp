#include "search.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "curve_sort.hpp"
#include "detp/sim/memory.hpp"
#include "detp/sim/technique/techniques.hpp"
#include "detp/sim/threads.hpp"
#include "gathering.hpp"
#include "ray_blocks.hpp"
#include "tree_search.hpp"

namespace detp::sim::stream {
namespace {

using Workers = tbb::enumerable_thread_specific<Worker>;

/// A node with fewer tests to make than this is not worth tasks of its own.
constexpr std::size_t least_work = std::size_t{1} << 16;

/// Makes tasks of the children while there is much to do.
void divide(const BlockSearch& block, const TreeNode& node, const RayLists& lists, Workers& workers) {
  if (node.leaf || size(lists) * node.count < least_work) {
    search_below(block, node, lists, workers.local());
    return;
  }
  // Isolated, so that a thread that waits takes no task that would heap its lists upon those in use.
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(node.first, node.first + node.count, [&](std::uint32_t child) {
      Worker& worker = workers.local();
      const ArenaScope scope(worker.lists);
      RayLists inside = worker.lists.take_like(lists, block.segments);
      cull_node(block, block.tree.nodes[child], lists, inside, worker);
      if (size(inside) > 0) divide(block, block.tree.nodes[child], inside, workers);
    });
  });
}

}  // namespace

bool can_search(const Problem& problem) { return Frame(problem).slack <= 0.01; }

double search_bytes(std::size_t discs, int threads) {
  constexpr double sorting = 2 * sizeof(CurvePlace);
  constexpr double nodes = 64;  // of both trees: a leaf of one disc has one of each, and half as many hold them
  constexpr double a_disc =
      sorting + sizeof(std::uint32_t) + sizeof(FloatDisc) + nodes + sizeof(ClassCounts) + 2 * sizeof(DiscTotals);
  constexpr double a_ray = 7 * sizeof(float);
  constexpr double within = 8;  // all lists made of a block's, one within another, in its rays
  const auto block = static_cast<double>(block_size(discs));
  return a_disc * static_cast<double>(discs) + a_ray * block * (2 + within * thread_count(threads));
}

void require_search_memory(const Problem& problem, const RunOptions& options) {
  require_memory(fmt::format("lists of rays over {} discs", problem.discs.size()),
                 search_bytes(problem.discs.size(), options.threads));
}

void search_boxes(const Problem& problem, const SphereTreeParameters& parameters, const RunOptions& options,
                  Outcome& outcome) {
  require_search_memory(problem, options);
  Stopwatch watch;
  const Frame frame(problem);
  on_threads(thread_count(options.threads), [&] {
    const DiscTree tree = make_disc_tree(problem, frame, parameters.fan_out, parameters.leaf);
    outcome.seconds.build = watch.lap();
    Workers workers;
    Gathering gathering(problem, tree, options);
    for_each_block(problem, frame, options.stop, [&](const Block& block) {
      divide(gathering.begin(frame, block.first(), block.traits()), tree.nodes.front(), block.lists(), workers);
    });
    gathering.give(workers, outcome);
  });
  if (options.count) outcome.counts.sorted = problem.discs.size();
  outcome.seconds.search = watch.lap();
}

}  // namespace detp::sim::stream
