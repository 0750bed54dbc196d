#include "search.hpp"

#include <array>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/threads.hpp"
#include "disc_results.hpp"
#include "list_search.hpp"
#include "ray_blocks.hpp"

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
      if (!enter(place)) return;
      if (rays().size > 0) test_discs(block_, k_, place, 1, rays(), worker_);
      worker_.counts.visits += k_ == 0 ? 1 : 0;
      worker_.counts.disc_tests += rays().size;
    }
  }

  /// Makes the lists for the disc at the next place. Returns false if a stop was requested.
  bool enter(std::uint32_t place) {
    const int first = walk_.enter(block_.problem.discs()[block_.tree.order[place]]);
    for (int level = first; level <= walk_.innermost(); ++level) {
      if (worker_.check.requested_after(test_work(lists_[static_cast<std::size_t>(level - 1)].size)))
        return skip_from(place);
      build(static_cast<std::size_t>(level), level == first);
    }
    return !worker_.check.requested_after(test_work(rays().size)) || skip_from(place);
  }

  /// The rays that may hit the disc of the latest place.
  [[nodiscard]] const RayList& rays() const { return lists_[static_cast<std::size_t>(walk_.innermost())]; }

  [[nodiscard]] ListArena& arena() { return worker_.lists; }

 private:
  bool skip_from(std::uint32_t place) {
    worker_.skipped.push_back({place, static_cast<std::uint32_t>(block_.tree.order.size()) - place});
    return false;
  }

  /// Makes a level's list. If `first`, frees the level's old list and all lists inside, which were culled from it.
  void build(std::size_t level, bool first) {
    if (first && level < built_) worker_.lists.release(marks_[level]);
    built_ = level + 1;
    marks_[level] = worker_.lists.mark();
    const RayList& around = lists_[level - 1];
    lists_[level] = worker_.lists.next(around.size, block_.segments);
    cull_sphere(block_, k_, block_.frame(walk_.sphere(static_cast<int>(level))), around, lists_[level], worker_);
    worker_.lists.keep(lists_[level]);
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

/// The walks of all classes together on one thread: no two threads may write the photon sums of a disc.
void run_together(const BlockSearch& block, std::array<ClassWalk, classes>& walks, Worker& worker) {
  const ArenaScope scopes[]{ArenaScope(walks[0].arena()), ArenaScope(walks[1].arena()), ArenaScope(walks[2].arena())};
  for (std::uint32_t place = 0; place < block.tree.order.size(); ++place) {
    for (ClassWalk& walk : walks)
      if (!walk.enter(place)) return;
    test_all_classes(block, place, 1, {walks[0].rays(), walks[1].rays(), walks[2].rays()}, worker);
  }
}

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
  const std::size_t expected = list_rays(size_of(problem, options), room);
  const auto worker = [&] { return Worker(options.memory, options.stop, expected); };
  std::array workers{worker(), worker(), worker()};
  using Events = std::pmr::vector<SphereCounts>;
  std::array events{Events(options.memory), Events(options.memory), Events(options.memory)};
  on_threads(thread_count(options.threads), [&] {
    DiscResults results(problem, discs, options, outcome);
    for_each_block(problem, frame, options, [&](const Block& rays) {
      const BlockSearch block = results.begin(frame, rays);
      std::array walk_of{make_walk(*options.memory), make_walk(*options.memory), make_walk(*options.memory)};
      const auto of_class = [&](int k) {
        const auto i = static_cast<std::size_t>(k);
        return ClassWalk(block, k, rays.lists()[i], *walk_of[i], workers[i], events[i]);
      };
      if (block.photons != nullptr) {
        std::array walks{of_class(0), of_class(1), of_class(2)};
        run_together(block, walks, workers[0]);
      } else {
        sim::parallel_for(0, classes, [&](int k) { of_class(k).run(); });
      }
      results.end(rays, workers);
    });
    results.store_results(workers);
  });
  if (!options.count) return;
  for (const Events& of_class : events) add(of_class, outcome.spheres);
}

}  // namespace detp::sim::stream
