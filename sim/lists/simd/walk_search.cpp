#include "walk_search.hpp"

#include <array>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/threads.hpp"
#include "disc_results.hpp"
#include "list_search.hpp"
#include "ray_blocks.hpp"
#include "search.hpp"

namespace detp::sim::stream {
namespace {

/// The walk for the rays of one class in one block.
class ClassWalk {
 public:
  ClassWalk(const BlockSearch& block, int k, const RayList& rays, ListWalk& walk, Worker& worker,
            std::pmr::vector<SphereCounts>& events)
      : block_(block),
        k_(k),
        walk_(walk),
        worker_(worker),
        events_(events),
        lists_(events.get_allocator()),
        marks_(events.get_allocator()) {
    const auto levels = static_cast<std::size_t>(walk.deepest()) + 1;
    lists_.resize(levels);
    marks_.resize(levels);
    lists_[0] = rays;
    events_.resize(levels - 1);
  }

  void run() {
    const ArenaScope scope(worker_.lists);
    for (std::uint32_t place = 0; place < block_.tree.order.size(); ++place) {
      const int first = walk_.enter(block_.problem.discs()[block_.tree.order[place]]);
      for (int level = first; level <= walk_.innermost(); ++level) {
        if (worker_.check.requested_after(test_work(lists_[static_cast<std::size_t>(level - 1)].size)))
          return skip_from(place);
        build(static_cast<std::size_t>(level), level == first);
      }
      const RayList& rays = lists_[static_cast<std::size_t>(walk_.innermost())];
      if (worker_.check.requested_after(test_work(rays.size))) return skip_from(place);
      if (rays.size > 0) test_discs(block_, k_, place, 1, rays, worker_);
      worker_.counts.visits += k_ == 0 ? 1 : 0;
      worker_.counts.disc_tests += rays.size;
    }
  }

 private:
  void skip_from(std::uint32_t place) {
    worker_.skipped.push_back({place, static_cast<std::uint32_t>(block_.tree.order.size()) - place});
  }

  /// Makes a level's list. If `first`, frees the level's old list and all lists inside, which were culled from it.
  void build(std::size_t level, bool first) {
    if (first && level < built_) worker_.lists.release(marks_[level]);
    built_ = level + 1;
    marks_[level] = worker_.lists.mark();
    const RayList& around = lists_[level - 1];
    lists_[level] = worker_.lists.allocate(around.size, block_.segments);
    cull_sphere(block_, k_, block_.frame(walk_.sphere(static_cast<int>(level))), around, lists_[level], worker_);
    worker_.counts.culls += k_ == 0 ? 1 : 0;
    worker_.counts.cull_tests += around.size;
    worker_.counts.listed += lists_[level].size;
    SphereCounts& events = events_[level - 1];
    events.rebuilds += block_.first_ray == 0 && k_ == 0 ? 1 : 0;
    events.tests += around.size;
    events.listed += lists_[level].size;
  }

  const BlockSearch& block_;
  int k_;
  ListWalk& walk_;
  Worker& worker_;
  std::pmr::vector<SphereCounts>& events_;
  std::pmr::vector<RayList> lists_;
  std::pmr::vector<ListArena::Mark> marks_;  ///< the arena's position before each list was made
  std::size_t built_ = 1;
};

void add(std::span<const SphereCounts> events, std::vector<SphereCounts>& sum) {
  sum.resize(events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    sum[i].rebuilds += events[i].rebuilds;
    sum[i].tests += events[i].tests;
    sum[i].listed += events[i].listed;
  }
}

}  // namespace

void search_walk(const SearchInput& input, const MakeWalk& make_walk, const ListCapacity& room,
                 const RunOptions& options, Outcome& outcome) {
  const Problem& problem = input.problem;
  const Frame& frame = input.frame;
  const DiscTree& discs = input.tree;
  const std::size_t floats = list_floats(size_of(problem, options), room);
  const auto worker = [&] { return Worker(options.memory, options.stop, floats); };
  std::array workers{worker(), worker(), worker()};
  using Events = std::pmr::vector<SphereCounts>;
  std::array events{Events(options.memory), Events(options.memory), Events(options.memory)};
  on_threads(thread_count(options.threads), [&] {
    DiscResults results(problem, discs, options, outcome);
    for_each_block(problem, frame, options, [&](const Block& rays) {
      const BlockSearch block = results.begin(frame, rays.first(), rays.traits());
      sim::parallel_for(0, classes, [&](int k) {
        const auto i = static_cast<std::size_t>(k);
        const OwnedIn<ListWalk> walk = make_walk(*options.memory);
        ClassWalk(block, k, rays.lists()[i], *walk, workers[i], events[i]).run();
      });
      results.end(rays, workers);
    });
    results.store_results(workers);
  });
  if (!options.count) return;
  for (const Events& of_class : events) add(of_class, outcome.spheres);
}

}  // namespace detp::sim::stream
