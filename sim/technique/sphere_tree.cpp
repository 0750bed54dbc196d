#include "detp/sim/base/stopwatch.hpp"

#include <algorithm>

#include "detp/sim/lists/plain/ray_list.hpp"
#include "detp/sim/lists/sphere_nodes.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "list_memory.hpp"
#include "technique.hpp"

namespace detp::sim {
namespace {

template <bool counting>
class Search {
 public:
  Search(const Problem& problem, const SphereTreeParameters& parameters, const SphereTree& tree,
         const std::vector<std::uint32_t>& order, const RunOptions& options, Outcome& outcome)
      : problem_(problem),
        parameters_(parameters),
        tree_(tree),
        order_(order),
        check_(options.stop, "searching"),
        outcome_(outcome),
        collector_(problem, options, outcome),
        lists_(tree.levels.size(), options.memory) {}

  void run() {
    collector_.save_totals();
    try {
      visit(tree_.levels.size() - 1, 0, list_of(problem_.rays(), lists_.get_allocator().resource()));
      place_ = order_.size();
    } catch (const Stopped&) {  // the unfinished disc or node is left out
    }
    outcome_.counts = tally_.counts();
    if (place_ < order_.size())
      collector_.store_partial_results(std::span(order_).first(place_));
    else
      collector_.store_results(problem_.rays().size());
  }

 private:
  void visit(std::size_t level, std::size_t number, const RayList& outer) {
    RayList& inside = lists_[level];
    check_.after(1);
    cull(outer, tree_.levels[level][number], problem_.slack(), inside, check_);
    tally_.add(&Counts<std::uint64_t>::cull_tests, outer.size());
    tally_.add(&Counts<std::uint64_t>::culls);
    tally_.add(&Counts<std::uint64_t>::listed, inside.size());
    if (inside.empty()) {
      place_ = std::min(order_.size(), (number + 1) * discs_below(level));
      return;
    }
    level == 0 ? test_discs(number, inside) : visit_children(level, number, inside);
  }

  /// Number of discs below a node of that level if the node and all below are full.
  std::size_t discs_below(std::size_t level) const {
    auto discs = static_cast<std::size_t>(parameters_.leaf);
    for (std::size_t i = 0; i < level && discs < order_.size(); ++i)
      discs *= static_cast<std::size_t>(parameters_.fan_out);
    return discs;
  }

  void visit_children(std::size_t level, std::size_t number, const RayList& inside) {
    const auto fan_out = static_cast<std::size_t>(parameters_.fan_out);
    const std::size_t end = std::min((number + 1) * fan_out, tree_.levels[level - 1].size());
    for (std::size_t child = number * fan_out; child < end; ++child) visit(level - 1, child, inside);
  }

  void test_discs(std::size_t number, const RayList& inside) {
    const auto leaf = static_cast<std::size_t>(parameters_.leaf);
    const std::size_t end = std::min((number + 1) * leaf, order_.size());
    tally_.add(&Counts<std::uint64_t>::visits, end - number * leaf);
    for (place_ = number * leaf; place_ < end; ++place_)
      test_disc(inside, problem_.discs()[order_[place_]], order_[place_], collector_, tally_, check_);
  }

  const Problem& problem_;
  const SphereTreeParameters& parameters_;
  const SphereTree& tree_;
  const std::vector<std::uint32_t>& order_;
  StopCheck check_;
  Outcome& outcome_;
  HitCollector collector_;
  Tally<counting> tally_;
  std::pmr::vector<RayList> lists_;  ///< one for each level, because children are visited one after another
  std::size_t place_ = 0;            ///< the discs before this place in the order are done
};

/// Culls the list of rays down the tree, depth first, and tests each leaf's list against the leaf's discs. Has one list
/// for each level.
class SphereTreeIndex final : public Index {
 public:
  SphereTreeIndex(const Problem& problem, const SphereTreeParameters& parameters, const RunOptions& options)
      : parameters_(parameters) {
    Stopwatch watch;
    built_.bytes = checked_bytes("a tree of spheres", building_bytes(problem, parameters), problem);
    order_ = along_curve(problem.discs(), SampleOrder::lebesgue, options.stop);
    built_.seconds.order = watch.lap();
    tree_ = make_sphere_tree(problem.discs(), order_, parameters, options.stop);
    built_.seconds.build = watch.lap();
    built_.counts.made = tree_.nodes();
    built_.counts.sorted = order_.size();
  }

  void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const override {
    add_checked_bytes("a tree of spheres and lists of rays", searching_bytes(problem, options, tree_), problem,
                      outcome);
    options.count ? Search<true>(problem, parameters_, tree_, order_, options, outcome).run()
                  : Search<false>(problem, parameters_, tree_, order_, options, outcome).run();
  }

 private:
  SphereTreeParameters parameters_;
  std::vector<std::uint32_t> order_;
  SphereTree tree_;
};

}  // namespace

std::unique_ptr<Index> prepare_sphere_tree(const Problem& problem, const Parameters& parameters,
                                           const RunOptions& options) {
  return std::make_unique<SphereTreeIndex>(problem, std::get<SphereTreeParameters>(parameters), options);
}

}  // namespace detp::sim
