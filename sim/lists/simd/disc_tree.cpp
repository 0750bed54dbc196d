#include "disc_tree.hpp"

#include <fmt/format.h>
#include <hwy/cache_control.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/geometry/curve_sort.hpp"
#include "detp/sim/search/run_memory.hpp"

namespace detp::sim::stream {
namespace {

struct FloatBox {
  float low[3];
  float high[3];

  void include(const FloatBox& box) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], box.low[axis]);
      high[axis] = std::max(high[axis], box.high[axis]);
    }
  }

  /// Half the box's surface, which is proportional to the number of lines that cross the box.
  [[nodiscard]] float area() const {
    const float x = high[0] - low[0];
    const float y = high[1] - low[1];
    const float z = high[2] - low[2];
    return x * y + y * z + z * x;
  }
};

constexpr FloatBox nothing{{2, 2, 2}, {-2, -2, -2}};

FloatBox box_of(const FloatDisc& disc) {
  FloatBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const float u = disc.normal[(axis + 1) % 3];
    const float v = disc.normal[(axis + 2) % 3];
    const float reach = disc.radius * std::sqrt(u * u + v * v);
    box.low[axis] = disc.centre[axis] - reach;
    box.high[axis] = disc.centre[axis] + reach;
  }
  return box;
}

/// Costs for one ray, in units of disc tests; measured on lists of a few hundred rays.
constexpr float cull_cost = 1.6F;  ///< one test of a ray against a box, with its share of making the list
constexpr float list_cost = 1.0F;  ///< each listed ray

/// A node of the binary tree. An inner node's left child is the next node.
struct Binary {
  FloatBox box;
  std::uint32_t first;
  std::uint32_t count;
  std::uint32_t right;  ///< number of the right child; 0: a leaf
  float cost;           ///< expected cost of a ray that crosses the box, times the box's area
  [[nodiscard]] bool leaf() const { return right == 0; }
};

static_assert(sizeof(Binary) == binary_node_bytes);

class Builder {
 public:
  Builder(const Problem& problem, const Frame& frame, const std::vector<CurvePlace>& places, DiscTree& tree,
          const BoxTreeParameters& parameters, const std::stop_token& stop)
      : problem_(problem),
        places_(places),
        sphere_area_(2 * std::numbers::pi * std::pow(problem.enclosing().radius * frame.scale, 2)),
        stop_(stop),
        widening_(stop, doing),
        tree_(tree),
        fan_out_(static_cast<std::size_t>(parameters.fan_out)),
        leaf_(static_cast<std::uint32_t>(parameters.leaf)) {}

  void build() {
    const auto discs = static_cast<std::uint32_t>(tree_.discs.size());
    // Reserves space for the largest possible number of nodes. Pages are only touched as far as nodes are written.
    binary_ = std::make_unique_for_overwrite<Binary[]>(2 * std::size_t{discs});
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
      written_ += split(first, count, number) - number;
      require_memory_for("the tree of boxes", building_bytes(tree_.discs.size(), static_cast<double>(written_), 0),
                         problem_);
      return;
    }
    const std::uint32_t middle = boundary(first, count);
    const std::uint32_t right = number + 2 * (middle - first);
    tbb::parallel_invoke([&] { split_in_parallel(first, middle - first, number + 1); },
                         [&] { split_in_parallel(middle, first + count - middle, right); });
    binary_[number] = {.box = nothing, .first = first, .count = count, .right = 0, .cost = 0};
    join(number, right);
    ++written_;
  }

  /// Writes the tree over a run of discs from `number` on. Returns the number after its last node.
  std::uint32_t split(std::uint32_t first, std::uint32_t count, std::uint32_t number) {
    binary_[number] = {.box = nothing, .first = first, .count = count, .right = 0, .cost = 0};
    if (count <= leaf_) {
      make_leaf(binary_[number]);
      return number + 1;
    }
    const std::uint32_t middle = boundary(first, count);
    const std::uint32_t right = split(first, middle - first, number + 1);
    const std::uint32_t end = split(middle, first + count - middle, right);
    join(number, right);
    return binary_[number].leaf() ? number + 1 : end;
  }

  /// Makes an inner node from its children, or drops them and makes a leaf if that costs less.
  void join(std::uint32_t number, std::uint32_t right_number) {
    Binary& node = binary_[number];
    const Binary& left = binary_[number + 1];
    const Binary& right = binary_[right_number];
    node.box = left.box;
    node.box.include(right.box);
    const float area = node.box.area();
    const float children = left.box.area() + right.box.area();
    // Culls and lists count half: about every other split is merged into a wide node and then costs nothing.
    const float inner = cull_cost * area + 0.5F * list_cost * children + left.cost + right.cost;
    const float as_leaf = static_cast<float>(node.count) * area;
    const bool drop = as_leaf <= inner && node.count <= most_in_a_leaf;
    node.cost = drop ? as_leaf : inner;
    node.right = drop ? 0 : right_number;
  }

  void make_leaf(Binary& node) const {
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) node.box.include(box_of(tree_.discs[i]));
    node.cost = static_cast<float>(node.count) * node.box.area();
  }

  /// The place at which the run leaves the first half of the smallest cell that contains the run; the run's middle if
  /// all its discs have the same place on the curve.
  std::uint32_t boundary(std::uint32_t first, std::uint32_t count) const {
    const std::uint32_t low = place_code(places_[first]);
    const std::uint32_t high = place_code(places_[first + count - 1]);
    if (low == high) return first + count / 2;
    const std::uint32_t start = high & ~(std::bit_floor(low ^ high) - 1);
    const auto begin = places_.begin() + first;
    const auto found =
        std::partition_point(begin, begin + count, [start](CurvePlace p) { return place_code(p) < start; });
    return static_cast<std::uint32_t>(found - places_.begin());
  }

  /// Writes binary node `number` at `place`, and its descendants. `around` is ListCapacity::all of the lists around it.
  void widen(std::uint32_t number, std::size_t place, double around) {
    const Binary& node = binary_[number];
    widening_.after(1);
    if (node.leaf()) {
      write(node, place, node.first, node.count, true);
      return;
    }
    std::vector<std::uint32_t> children{number + 1, node.right};
    while (children.size() < fan_out_) {
      const auto largest = std::max_element(children.begin(), children.end(), [&](std::uint32_t x, std::uint32_t y) {
        return inner_area(x) < inner_area(y);
      });
      if (inner_area(*largest) < 0) break;
      const std::uint32_t right = binary_[*largest].right;
      ++*largest;
      children.insert(largest + 1, right);
    }
    const std::size_t first = tree_.nodes.size();
    tree_.nodes.resize(first + children.size());
    write(node, place, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(children.size()), false);
    if (number == 0)
      for (const std::uint32_t child : children) tree_.lists.first = std::max(tree_.lists.first, share(child));
    const double room = number == 0 ? tree_.lists.first : around + share(number);
    tree_.lists.all = std::max(tree_.lists.all, room);
    for (std::size_t i = 0; i < children.size(); ++i) widen(children[i], first + i, room);
  }

  /// Share of the lines through S₀ that cross a node's box.
  double share(std::uint32_t number) const { return std::min(1.0, binary_[number].box.area() / sphere_area_); }

  float inner_area(std::uint32_t number) const { return binary_[number].leaf() ? -1.0F : binary_[number].box.area(); }

  void write(const Binary& node, std::size_t place, std::uint32_t first, std::uint32_t count, bool leaf) {
    TreeNode& written = tree_.nodes[place];
    for (int axis = 0; axis < 3; ++axis) {
      written.centre[axis] = 0.5F * (node.box.low[axis] + node.box.high[axis]);
      written.half[axis] = 0.5F * (node.box.high[axis] - node.box.low[axis]);
    }
    written.first = first;
    written.count = count & 0x7fff'ffff;
    written.leaf = leaf ? 1 : 0;
  }

  static constexpr std::uint32_t most_in_a_leaf = 64;
  static constexpr const char* doing = "building the tree of boxes";

  const Problem& problem_;
  const std::vector<CurvePlace>& places_;
  double sphere_area_;  ///< half the surface of S₀
  const std::stop_token& stop_;
  StopCheck widening_;
  DiscTree& tree_;
  std::size_t fan_out_;
  std::uint32_t leaf_;
  std::unique_ptr<Binary[]> binary_;
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

namespace {

/// Runs on the threads of the caller's arena.
DiscTree tree_in_order(const Problem& problem, const Frame& frame, std::vector<std::uint32_t> order,
                       const std::stop_token& stop) {
  constexpr std::size_t grain = 4096;
  constexpr std::size_t prefetch_distance = 32;  // number of discs to prefetch
  DiscTree tree;
  tree.order = std::move(order);
  tree.discs.resize(tree.order.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tree.order.size(), grain), [&](const auto& range) {
    StopCheck check(stop, "putting discs in order");
    for_each_checked(range.begin(), range.end(), check, [&](std::size_t place) {
      if (place + prefetch_distance < tree.order.size())
        hwy::Prefetch(&problem.discs()[tree.order[place + prefetch_distance]]);
      tree.discs[place] = to_float(problem.discs()[tree.order[place]], frame);
    });
    check.now();
  });
  return tree;
}

}  // namespace

DiscTree discs_in_order(const Problem& problem, const Frame& frame, std::vector<std::uint32_t> order,
                        const RunOptions& options) {
  DiscTree tree;
  on_threads(thread_count(options.threads),
             [&] { tree = tree_in_order(problem, frame, std::move(order), options.stop); });
  return tree;
}

double building_bytes(std::size_t discs, double binary_nodes, double nodes) {
  constexpr double in_order = sizeof(FloatDisc) + sizeof(std::uint32_t) + sizeof(CurvePlace);
  return in_order * static_cast<double>(discs) + binary_node_bytes * binary_nodes + sizeof(TreeNode) * nodes;
}

DiscTree make_disc_tree(const Problem& problem, const Frame& frame, const BoxTreeParameters& parameters,
                        const RunOptions& options) {
  if (problem.discs().size() >= std::size_t{1} << 31)
    throw std::length_error(
        fmt::format("{} discs are too many for a tree of boxes; the most is 2147483647", problem.discs().size()));
  DiscTree tree;
  on_threads(thread_count(options.threads), [&] {
    const std::vector<CurvePlace> places = sort_along_curve(problem.discs(), options.stop);
    std::vector<std::uint32_t> order;
    order.reserve(places.size());
    for (const CurvePlace place : places) order.push_back(place_index(place));
    tree = tree_in_order(problem, frame, std::move(order), options.stop);
    Builder(problem, frame, places, tree, parameters, options.stop).build();
  });
  return tree;
}

}  // namespace detp::sim::stream
