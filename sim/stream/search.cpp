#include "search.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "detp/sim/technique/techniques.hpp"
#include "load_rays.hpp"
#include "tree_search.hpp"

namespace detp::sim::stream {
namespace {

/// Rays in a block: its lists (20 or 28 bytes a ray) stay in the second-level cache while they are culled.
constexpr std::size_t block_size = std::size_t{1} << 17;

/// A subtree with fewer tests than this is not worth a task.
constexpr std::size_t least_work = std::size_t{1} << 16;

/// A block of rays, loaded.
struct Block {
  ListArena arena;
  RayLists lists;
  std::size_t first = 0;
  RayTraits traits;
};

class Search {
 public:
  Search(const Problem& problem, const Frame& frame, const DiscTree& tree, const RunOptions& options)
      : problem_(problem), frame_(frame), tree_(tree), options_(options), totals_(tree.discs.size()) {
    if (options.totals != nullptr && !options.totals->empty())
      for (std::size_t place = 0; place < totals_.size(); ++place) totals_[place] = (*options.totals)[tree.order[place]];
  }

  void run() {
    Block now;
    Block next;
    load(0, now);
    while (now.first < problem_.rays.size() && !options_.stop.stop_requested()) {
      const std::size_t after = now.first + block_size;
      tbb::parallel_invoke([&] { load(after, next); }, [&] { search(now); });
      std::swap(now, next);
    }
  }

  void give(Outcome& outcome) {
    add_counted();
    std::uint64_t before = 0;
    if (options_.totals != nullptr)
      for (const DiscTotals& disc : *options_.totals) before += disc.hits;
    Totals in_order(totals_.size());
    for (std::size_t place = 0; place < totals_.size(); ++place) in_order[tree_.order[place]] = totals_[place];
    for (const DiscTotals& disc : in_order) outcome.total_hits += disc.hits;
    outcome.total_hits -= before;
    for (Worker& worker : workers_) {
      outcome.pairs.insert(outcome.pairs.end(), worker.pairs.begin(), worker.pairs.end());
      outcome.counts.sphere_tests += worker.counts.sphere_tests;
      outcome.counts.disc_tests += worker.counts.disc_tests;
      outcome.counts.copies += worker.counts.copies;
      outcome.counts.rebuilds += worker.counts.rebuilds;
    }
    std::sort(outcome.pairs.begin(), outcome.pairs.end());
    outcome.counts.sorted = totals_.size();
    outcome.counts.hits = outcome.total_hits;
    if (!options_.count) outcome.counts = {.hits = outcome.total_hits};
    outcome.stopped = options_.stop.stop_requested();
    if (options_.totals != nullptr)
      *options_.totals = std::move(in_order);
    else
      finish(in_order, problem_.discs, outcome);
  }

 private:
  /// Hits that were only counted: adds up their powers, one after another.
  void add_counted() {
    if (!counted_power_) return;
    std::vector<double> sums{0};
    const auto sum_of = [&](std::size_t count) {
      while (sums.size() <= count) sums.push_back(sums.back() + *counted_power_);
      return sums[count];
    };
    for (std::size_t place = 0; place < totals_.size(); ++place)
      for (int k = 0; k < classes; ++k) {
        const std::uint32_t count = std::exchange(counted_[place][static_cast<std::size_t>(k)], 0);
        double& sum = totals_[place].power[k];
        totals_[place].hits += count;
        if (sum == 0)
          sum = sum_of(count);
        else
          for (std::uint32_t i = 0; i < count; ++i) sum += *counted_power_;
      }
  }

  void load(std::size_t first, Block& block) const {
    block.first = first;
    if (first >= problem_.rays.size()) return;
    const auto rays = problem_.rays.subspan(first, std::min(block_size, problem_.rays.size() - first));
    block.arena.release({});
    for (RayList& list : block.lists) list = block.arena.take(rays.size(), true);
    block.traits = load_rays(rays, frame_, block.lists);
  }

  void search(const Block& block) {
    const bool count = block.traits.power && !options_.pairs && !problem_.front_facing;
    if (!count || block.traits.power != counted_power_) add_counted();
    counted_power_ = count ? block.traits.power : std::nullopt;
    if (count) counted_.resize(totals_.size());
    const BlockSearch shared{.problem = problem_,
                             .frame = frame_,
                             .tree = tree_,
                             .first_ray = static_cast<std::uint32_t>(block.first),
                             .segments = block.traits.segments,
                             .pairs = options_.pairs,
                             .counted = counted_.empty() ? nullptr : counted_.data(),
                             .totals = totals_.data(),
                             .stop = options_.stop};
    divide(shared, tree_.nodes.front(), block.lists);
  }

  /// Makes the children tasks of their own while there is much to do.
  void divide(const BlockSearch& block, const TreeNode& node, const RayLists& lists) {
    if (node.leaf || size(lists) * node.count < least_work) {
      search_below(block, node, lists, workers_.local());
      return;
    }
    tbb::this_task_arena::isolate([&] {
      tbb::parallel_for(node.first, node.first + node.count, [&](std::uint32_t child) {
        Worker& worker = workers_.local();
        const ArenaScope scope(worker.lists);
        RayLists inside = worker.lists.take_like(lists, block.segments);
        cull_node(block, tree_.nodes[child], lists, inside, worker);
        if (size(inside) > 0) divide(block, tree_.nodes[child], inside);
      });
    });
  }

  const Problem& problem_;
  const Frame& frame_;
  const DiscTree& tree_;
  const RunOptions& options_;
  Totals totals_;                     ///< in the tree's order
  std::vector<ClassCounts> counted_;  ///< likewise: hits of blocks in which all rays carry …
  std::optional<double> counted_power_;  ///< … this; nothing while totals_ are complete
  tbb::enumerable_thread_specific<Worker> workers_;
};

}  // namespace

bool can_search(const Problem& problem) { return Frame(problem).slack <= 0.01; }

void search_boxes(const Problem& problem, const SphereTreeParameters& parameters, const RunOptions& options,
                  Outcome& outcome) {
  Stopwatch watch;
  const Frame frame(problem);
  const DiscTree tree = make_disc_tree(problem, frame, parameters.fan_out, parameters.leaf);
  outcome.seconds.build = watch.lap();
  tbb::task_arena arena(options.threads == 0 ? tbb::task_arena::automatic : options.threads);
  arena.execute([&] {
    Search search(problem, frame, tree, options);
    search.run();
    search.give(outcome);
  });
  outcome.seconds.search = watch.lap();
}

}  // namespace detp::sim::stream
