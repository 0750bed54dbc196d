#include "walk_index.hpp"

#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/lists/plain/ray_list.hpp"
#include "detp/sim/lists/plain/walk_search.hpp"
#include "detp/sim/lists/simd/search.hpp"
#include "detp/sim/search/run_memory.hpp"

namespace detp::sim {
namespace {

std::uint64_t sorted_discs(const WalkedSpheres& spheres, const Problem& problem) {
  return spheres.order == SampleOrder::none ? 0 : problem.discs().size();
}

class PlainWalk final : public Index {
 public:
  PlainWalk(const Problem& problem, WalkedSpheres spheres, const RunOptions& options) : spheres_(std::move(spheres)) {
    Stopwatch watch;
    built_.bytes = checked_bytes(spheres_.what, walk_bytes(problem, options, spheres_.lists, true), problem);
    order_ = along_curve(problem.discs(), spheres_.order, options.stop);
    built_.seconds.order = watch.lap();
    built_.counts.sorted = sorted_discs(spheres_, problem);
  }

  void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const override {
    add_checked_bytes(spheres_.what, walk_bytes(problem, options, spheres_.lists, true), problem, outcome);
    search_along(*spheres_.make_walk(*options.memory), problem, order_, options, outcome);
  }

 private:
  WalkedSpheres spheres_;
  std::vector<std::uint32_t> order_;
};

class FloatWalk final : public Index {
 public:
  FloatWalk(const Problem& problem, WalkedSpheres spheres, const RunOptions& options)
      : spheres_(std::move(spheres)), frame_(problem) {
    Stopwatch watch;
    built_.bytes = checked_bytes(spheres_.what, walk_bytes(problem, options, spheres_.lists, false), problem);
    const std::vector<std::uint32_t> order = along_curve(problem.discs(), spheres_.order, options.stop);
    built_.seconds.order = watch.lap();
    discs_ = stream::discs_in_order(problem, frame_, {order.begin(), order.end()}, options);
    built_.seconds.build = watch.lap();
    built_.counts.sorted = sorted_discs(spheres_, problem);
  }

  void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const override {
    add_checked_bytes(spheres_.what, walk_bytes(problem, options, spheres_.lists, false), problem, outcome);
    stream::search_walk({problem, frame_, discs_}, spheres_.make_walk, spheres_.lists.capacity(), options, outcome);
  }

 private:
  WalkedSpheres spheres_;
  stream::Frame frame_;
  stream::DiscTree discs_;
};

}  // namespace

std::unique_ptr<Index> prepare_walk(const Problem& problem, WalkedSpheres spheres, const RunOptions& options) {
  if (options.engine == Engine::simd && stream::can_search(problem))
    return std::make_unique<FloatWalk>(problem, std::move(spheres), options);
  return std::make_unique<PlainWalk>(problem, std::move(spheres), options);
}

}  // namespace detp::sim
