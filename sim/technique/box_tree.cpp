#include "box_tree.hpp"

#include <deque>
#include <optional>
#include <utility>

#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/geometry/ray_box.hpp"
#include "detp/sim/lists/plain/ray_list.hpp"
#include "detp/sim/lists/simd/search.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "list_memory.hpp"
#include "technique.hpp"

namespace detp::sim {
namespace {

using stream::DiscTree;
using stream::Frame;
using stream::TreeNode;

/// The box of a node in scene units, grown by the rounding errors of floats and by the slack.
Box grown_box(const TreeNode& node, const Frame& frame) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const double half = static_cast<double>(node.half[axis]) + frame.margin;
    box.low[axis] = frame.centre[axis] + (node.centre[axis] - half) / frame.scale;
    box.high[axis] = frame.centre[axis] + (node.centre[axis] + half) / frame.scale;
  }
  return box;
}

/// Lists in `inside` the rays of `around` that meet the box.
void cull(const RayList& around, const Box& box, RayList& inside, StopCheck& check) {
  inside.clear();
  inside.reserve(around.size());  // pages are only touched as far as the list is filled
  for_each_checked(std::span(around), check, [&](const ListedRay& listed) {
    if (!ClippedRay(listed.ray).inside(box).empty()) inside.push_back(listed);
  });
}

/// The search of the plain engine: the same tree as simd, but in double precision, one ray and one disc at a time.
template <bool counting>
class PlainSearch {
 public:
  PlainSearch(const stream::SearchInput& input, const RunOptions& options, Outcome& outcome)
      : input_(input),
        check_(options.stop, "searching"),
        outcome_(outcome),
        collector_(input.problem, options, outcome),
        lists_(options.memory) {}

  void run() {
    const auto& order = input_.tree.order;
    collector_.save_totals();
    try {
      visit(input_.tree.nodes.front(), 0, list_of(input_.problem.rays(), lists_.get_allocator().resource()));
      done_ = order.size();
    } catch (const Stopped&) {  // the unfinished disc or node is left out
    }
    outcome_.counts = tally_.counts();
    if (done_ < order.size())
      collector_.store_partial_results(std::span(order).first(done_));
    else
      collector_.store_results(input_.problem.rays().size());
  }

 private:
  void visit(const TreeNode& node, std::size_t level, const RayList& rays) {
    if (node.leaf) return test_discs(node, rays);
    if (lists_.size() == level) lists_.emplace_back();
    RayList& inside = lists_[level];
    for (std::uint32_t child = node.first; child < node.first + node.count; ++child) {
      const TreeNode& next = input_.tree.nodes[child];
      check_.after(1);
      cull(rays, grown_box(next, input_.frame), inside, check_);
      tally_.add(&Counts<std::uint64_t>::cull_tests, rays.size());
      tally_.add(&Counts<std::uint64_t>::culls);
      tally_.add(&Counts<std::uint64_t>::listed, inside.size());
      if (inside.empty())
        done_ = end_of(next);
      else
        visit(next, level + 1, inside);
    }
  }

  /// One past the last of the discs below a node.
  [[nodiscard]] std::size_t end_of(const TreeNode& node) const {
    const stream::DiscRun run = discs_below(input_.tree, node);
    return std::size_t{run.first} + run.count;
  }

  void test_discs(const TreeNode& leaf, const RayList& rays) {
    tally_.add(&Counts<std::uint64_t>::visits, leaf.count);
    for (done_ = leaf.first; done_ < leaf.first + leaf.count; ++done_) {
      const std::uint32_t disc = input_.tree.order[done_];
      test_disc(rays, input_.problem.discs()[disc], disc, collector_, tally_, check_);
    }
  }

  const stream::SearchInput& input_;
  StopCheck check_;
  Outcome& outcome_;
  HitCollector collector_;
  Tally<counting> tally_;
  std::pmr::deque<RayList> lists_;  ///< one for each level, because children are visited one after another
  std::size_t done_ = 0;            ///< number of discs before the current one in the order
};

/// Culls lists of rays down a tree of boxes, and tests the leaves' lists against their discs.
class BoxTreeIndex final : public Index {
 public:
  BoxTreeIndex(const Problem& problem, const BoxTreeParameters& parameters, const RunOptions& options,
               std::optional<stream::SortedDiscs> sorted = {})
      : parameters_(parameters), simd_(options.engine == Engine::simd && stream::can_search(problem)), frame_(problem) {
    Stopwatch watch;
    const stream::TreeSize expected = stream::expected_tree(problem.discs().size(), parameters);
    checked_bytes(what, stream::boxes_bytes(stream::size_of(problem, options), expected), problem);
    const double sort_seconds = sorted ? sorted->seconds : 0;  // before this constructor
    if (!sorted) sorted = stream::sort_discs(problem, frame_, options, parameters.leaf);
    const std::size_t newly_sorted = sorted->sorted;
    tree_ = stream::make_disc_tree(std::move(*sorted), problem, frame_, parameters, options);
    const double built = stream::building_bytes(problem.discs().size(), static_cast<double>(tree_.binary_nodes),
                                                static_cast<double>(tree_.nodes.size()));
    built_.bytes = checked_bytes(what, built, problem);
    built_.seconds.build = sort_seconds + watch.lap();
    built_.counts.made = tree_.binary_nodes;
    built_.counts.sorted = newly_sorted;
    built_.counts.placements = built_.counts.references = problem.discs().size();
  }

  void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const override {
    const stream::SearchInput input{problem, frame_, tree_};
    if (simd_) return search_boxes(input, options, outcome);
    const double tree = sizeof(stream::FloatDisc) * static_cast<double>(tree_.discs.size()) +
                        sizeof(TreeNode) * static_cast<double>(tree_.nodes.size());
    add_checked_bytes(what, tree + listing_bytes(problem, options, tree_.lists.all), problem, outcome);
    options.count ? PlainSearch<true>(input, options, outcome).run()
                  : PlainSearch<false>(input, options, outcome).run();
  }

 private:
  static constexpr const char* what = "the tree of boxes and its lists of rays";

  BoxTreeParameters parameters_;
  bool simd_;
  Frame frame_;
  DiscTree tree_;
};

}  // namespace

std::unique_ptr<Index> prepare_box_tree(const Problem& problem, stream::SortedDiscs discs,
                                        const BoxTreeParameters& parameters, const RunOptions& options) {
  return std::make_unique<BoxTreeIndex>(problem, parameters, options, std::move(discs));
}

std::unique_ptr<Index> prepare_box_tree(const Problem& problem, const Parameters& parameters,
                                        const RunOptions& options) {
  return std::make_unique<BoxTreeIndex>(problem, std::get<BoxTreeParameters>(parameters), options);
}

}  // namespace detp::sim
