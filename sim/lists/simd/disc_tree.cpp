#include "disc_tree.hpp"

#include <fmt/format.h>
#include <hwy/cache_control.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "binary_tree.hpp"
#include "detp/sim/base/page_pool.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "search.hpp"

namespace detp::sim::stream {
namespace {

class Builder {
 public:
  Builder(const Problem& problem, const Frame& frame, SortedDiscs& discs, const BoxTreeParameters& parameters,
          const std::stop_token& stop)
      : problem_(problem),
        discs_(discs),
        sphere_area_(2 * std::numbers::pi * std::pow(problem.enclosing().radius * frame.scale, 2)),
        stop_(stop),
        widening_(stop, doing),
        tree_(discs.tree),
        parameters_(parameters),
        fan_out_(static_cast<std::size_t>(parameters.fan_out)),
        leaf_(static_cast<std::uint32_t>(parameters.leaf)) {}

  void build() {
    const auto discs = static_cast<std::uint32_t>(tree_.discs.size());
    // Reserves space for the largest possible number of nodes. Pages are only touched as far as nodes are written.
    const std::size_t most = 2 * std::size_t{discs};
    const UntouchedBytes block = allocate_untouched(page_pool(), most * sizeof(BinaryNode));
    binary_ = {static_cast<BinaryNode*>(block.start), {&page_pool(), most}};
    fresh_ = block.fresh;
    split_in_parallel(0, discs, 0);
    tree_.binary_nodes = written_;
    tree_.nodes.reserve(written_);
    tree_.nodes.emplace_back();
    widen(0, 0, 0);
  }

 private:
  /// Writes the binary tree over a run of discs: the root at `number`, the other nodes among the next 2 count - 2. The
  /// tree's shape does not depend on the number of threads.
  void split_in_parallel(std::uint32_t first, std::uint32_t count, std::uint32_t number) {
    constexpr std::uint32_t least = 1U << 15;  // smallest number of discs for a task of its own
    StopCheck check(stop_, doing);
    check.after(2 * std::min(count, least));
    check.now();
    if (count < least) {
      if (fresh_)
        touch_pages(&binary_[number],
                    static_cast<std::size_t>(expected_tree(count, parameters_).binary_nodes) * sizeof(BinaryNode));
      written_ += split_run(discs_, leaf_, first, count, binary_.get(), number) - number;
      require_memory_for("the tree of boxes", building_bytes(tree_.discs.size(), static_cast<double>(written_), 0),
                         problem_);
      return;
    }
    const std::uint32_t middle = boundary(*discs_.places, first, count);
    const std::uint32_t right = number + 2 * (middle - first);
    sim::parallel_invoke([&] { split_in_parallel(first, middle - first, number + 1); },
                         [&] { split_in_parallel(middle, first + count - middle, right); });
    binary_[number] = {.box = nothing, .first = first, .count = count, .right = 0, .cost = 0};
    join(binary_[number], binary_[number + 1], binary_[right], right);
    ++written_;
  }

  /// Writes binary node `number` at `place`, and its descendants. `around` is ListCapacity::all of the lists around it.
  void widen(std::uint32_t number, std::size_t place, double around) {
    const BinaryNode& node = binary_[number];
    widening_.after(1);
    if (node.leaf()) {
      write(node, place, node.first, node.count, true);
      return;
    }
    std::vector<WideChild> children;
    const auto child = [this](std::uint32_t one) { return WideChild{one, inner_area(one)}; };
    open_wide_node(
        number, fan_out_, [&](std::uint32_t inner) { return std::pair(child(inner + 1), child(binary_[inner].right)); },
        children);
    const std::size_t first = tree_.nodes.size();
    tree_.nodes.resize(first + children.size());
    write(node, place, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(children.size()), false);
    if (number == 0)
      for (const WideChild& one : children) tree_.lists.first = std::max(tree_.lists.first, share(one.node));
    const double room = number == 0 ? tree_.lists.first : around + share(number);
    tree_.lists.all = std::max(tree_.lists.all, room);
    for (std::size_t i = 0; i < children.size(); ++i) widen(children[i].node, first + i, room);
  }

  /// Share of the lines through S₀ that cross a node's box.
  double share(std::uint32_t number) const { return std::min(1.0, binary_[number].box.area() / sphere_area_); }

  float inner_area(std::uint32_t number) const { return binary_[number].leaf() ? -1.0F : binary_[number].box.area(); }

  void write(const BinaryNode& node, std::size_t place, std::uint32_t first, std::uint32_t count, bool leaf) {
    TreeNode& written = tree_.nodes[place];
    for (int axis = 0; axis < 3; ++axis) {
      written.centre[axis] = 0.5F * (node.box.low[axis] + node.box.high[axis]);
      written.half[axis] = 0.5F * (node.box.high[axis] - node.box.low[axis]);
    }
    written.first = first;
    written.count = count & 0x7fff'ffff;
    written.leaf = leaf ? 1 : 0;
  }

  static constexpr const char* doing = "building the tree of boxes";

  const Problem& problem_;
  SortedDiscs& discs_;
  double sphere_area_;  ///< half the surface of S₀
  const std::stop_token& stop_;
  StopCheck widening_;
  DiscTree& tree_;
  const BoxTreeParameters& parameters_;
  std::size_t fan_out_;
  std::uint32_t leaf_;
  Untouched<BinaryNode> binary_;
  bool fresh_ = false;  ///< some pages of binary_ are new
  std::atomic<std::size_t> written_ = 0;
};

FloatDisc to_float(const Disc& disc, const Frame& frame) {
  FloatDisc as_float{};
  const glm::dvec3 centre = frame(disc.centre);
  for (int axis = 0; axis < 3; ++axis) {
    as_float.centre[axis] = static_cast<float>(centre[axis]);
    as_float.normal[axis] = static_cast<float>(disc.normal[axis]);
  }
  as_float.radius = static_cast<float>(disc.radius * frame.scale);
  as_float.band = frame.band(disc.radius * frame.scale);
  return as_float;
}

}  // namespace

DiscRun discs_below(const DiscTree& tree, const TreeNode& node) {
  const TreeNode* first = &node;
  const TreeNode* last = &node;
  while (!first->leaf) first = &tree.nodes[first->first];
  while (!last->leaf) last = &tree.nodes[last->first + last->count - 1];
  return {first->first, last->first + last->count - first->first};
}

DiscTree discs_in_order(const Problem& problem, const Frame& frame, UnsetVector<std::uint32_t> order,
                        const RunOptions& options) {
  constexpr std::size_t grain = 4096;
  constexpr std::size_t prefetch_distance = 32;  // number of discs to prefetch
  DiscTree tree;
  tree.order = std::move(order);
  tree.discs.resize(tree.order.size());
  on_threads(thread_count(options.threads), [&] {
    sim::parallel_for(ParallelRange(0, tree.order.size(), grain), [&](const auto& range) {
      StopCheck check(options.stop, "putting discs in order");
      for_each_checked(range.begin(), range.end(), check, [&](std::size_t place) {
        if (place + prefetch_distance < tree.order.size()) {
          const Disc& later = problem.discs()[tree.order[place + prefetch_distance]];
          hwy::Prefetch(&later.centre);  // a disc may lie in two cache lines
          hwy::Prefetch(&later.radius);
        }
        tree.discs[place] = to_float(problem.discs()[tree.order[place]], frame);
      });
      check.now();
    });
  });
  return tree;
}

double building_bytes(std::size_t discs, double binary_nodes, double nodes) {
  constexpr double in_order = sizeof(FloatDisc) + sizeof(std::uint32_t) + sizeof(CurvePlace);
  return in_order * static_cast<double>(discs) + binary_node_bytes * binary_nodes + sizeof(TreeNode) * nodes;
}

CurveOrder curve_order(const Problem& problem, const RunOptions& options, int leaf) {
  if (problem.discs().size() >= std::size_t{1} << 31)
    throw std::length_error(
        fmt::format("{} discs are too many for a tree of boxes; the most is 2147483647", problem.discs().size()));
  CurveOrder places;
  on_threads(thread_count(options.threads), [&] {
    places = std::make_shared<const CurvePlaces>(
        sort_along_curve(problem.discs(), problem.centres(), static_cast<std::size_t>(leaf), options.stop));
  });
  return places;
}

SortedDiscs sort_discs(const Problem& problem, const Frame& frame, const RunOptions& options, int leaf) {
  const Stopwatch watch;
  SortedDiscs sorted = discs_in_known_order(problem, frame, curve_order(problem, options, leaf), options);
  sorted.sorted = problem.discs().size();
  sorted.seconds = watch.seconds();
  return sorted;
}

SortedDiscs discs_in_known_order(const Problem& problem, const Frame& frame, CurveOrder places,
                                 const RunOptions& options) {
  if (places->size() != problem.discs().size())
    throw std::invalid_argument(
        fmt::format("the order of {} discs is not one of {} discs", places->size(), problem.discs().size()));
  const Stopwatch watch;
  UnsetVector<std::uint32_t> order(places->size());
  std::transform(places->begin(), places->end(), order.begin(), place_index);
  SortedDiscs sorted{.places = std::move(places), .tree = discs_in_order(problem, frame, std::move(order), options)};
  sorted.seconds = watch.seconds();
  return sorted;
}

DiscTree make_disc_tree(SortedDiscs sorted, const Problem& problem, const Frame& frame,
                        const BoxTreeParameters& parameters, const RunOptions& options) {
  on_threads(thread_count(options.threads), [&] { Builder(problem, frame, sorted, parameters, options.stop).build(); });
  return std::move(sorted.tree);
}

DiscTree make_disc_tree(const Problem& problem, const Frame& frame, const BoxTreeParameters& parameters,
                        const RunOptions& options) {
  return make_disc_tree(sort_discs(problem, frame, options, parameters.leaf), problem, frame, parameters, options);
}

}  // namespace detp::sim::stream
