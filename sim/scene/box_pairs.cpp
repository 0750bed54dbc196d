#include "box_pairs.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <limits>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stop_check.hpp"

namespace detp::sim {
namespace {

constexpr const char* seeking = "looking for faces in the same place";
constexpr std::uint64_t work_of_match = 16;
constexpr std::size_t most_in_leaf = 4;
constexpr std::size_t least_for_threads = 1 << 14;
constexpr std::size_t leaves_in_a_part = 1 << 10;  // a power of two, as the number of leaves

/// In single precision, which halves the memory.
struct SmallBox {
  glm::vec3 low{std::numeric_limits<float>::infinity()};
  glm::vec3 high{-std::numeric_limits<float>::infinity()};

  void include(const SmallBox& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  [[nodiscard]] float longest_side() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }
};

bool touch(const SmallBox& a, const SmallBox& b) {
  const auto meet = [&](int axis) {
    return static_cast<int>(a.low[axis] <= b.high[axis]) & static_cast<int>(b.low[axis] <= a.high[axis]);
  };
  return (meet(0) & meet(1) & meet(2)) != 0;  // without branches, which nobody can predict
}

/// Coordinates in which all boxes are between -1 and 1.
class SmallUnits {
 public:
  /// For boxes within this one, which may be empty.
  explicit SmallUnits(const Box& all) {
    if (all.empty()) return;
    centre_ = all.centre();
    if (all.longest_side() > 0) unit_ = 0.5 * all.longest_side();
  }

  /// Holds the box.
  [[nodiscard]] SmallBox small(const Box& box) const {
    constexpr float rounding = 1.3e-7F;
    return {glm::vec3((box.low - centre_) / unit_) - rounding, glm::vec3((box.high - centre_) / unit_) + rounding};
  }
  [[nodiscard]] Box large(const SmallBox& box) const {
    return {centre_ + unit_ * glm::dvec3(box.low), centre_ + unit_ * glm::dvec3(box.high)};
  }

 private:
  glm::dvec3 centre_{0.0};
  double unit_ = 1;
};

/// A binary tree over boxes, all of whose leaves are at the same depth. Nodes have the numbers of a heap: 1 is the root,
/// 2k and 2k + 1 are the children of k.
class PairTree {
 public:
  PairTree(std::size_t boxes, const BoxPairTests& tests, const std::stop_token& stop)
      : tests_(tests), stop_(stop), units_(box_of_all(boxes, tests, stop)) {
    while (boxes > most_in_leaf << depth_) ++depth_;
    nodes_.resize(2 * leaves());
    places_.resize(leaves() + 1, static_cast<std::uint32_t>(boxes));
    std::vector<SmallBox> small;
    std::vector<Centre> centres;
    small.reserve(boxes);
    centres.reserve(boxes);
    StopCheck check(stop_, seeking);
    for_each_checked(0, boxes, check, [&](std::size_t i) {
      const auto number = static_cast<std::uint32_t>(i);
      small.push_back(units_.small(tests_.box(number)));
      centres.push_back({small.back().low + small.back().high, number});
    });
    items_.resize(boxes);
    build(1, small, centres, 0, check);
  }

  [[nodiscard]] std::size_t leaves() const { return std::size_t{1} << depth_; }

  /// Adds the pairs of a leaf's items with each other and with those of later leaves.
  void add_pairs(std::size_t leaf, StopCheck& check, std::vector<BoxPair>& pairs) const {
    const std::size_t from = leaves() + leaf;
    match(from, from, check, pairs);
    for (std::size_t node = from; node > 1; node /= 2)
      if (node % 2 == 0) descend(node + 1, from, check, pairs);
  }

 private:
  static Box box_of_all(std::size_t boxes, const BoxPairTests& tests, const std::stop_token& stop) {
    StopCheck check(stop, seeking);
    Box all;
    for_each_checked(0, boxes, check, [&](std::size_t i) {
      const Box box = tests.box(static_cast<std::uint32_t>(i));
      all.include(box.low);
      all.include(box.high);
    });
    return all;
  }

  struct Centre {
    glm::vec3 doubled;
    std::uint32_t number;
  };
  struct Item {
    SmallBox box;
    std::uint32_t number;
  };

  [[nodiscard]] bool is_leaf(std::size_t node) const { return node >> depth_ != 0; }
  [[nodiscard]] std::span<const Item> items_of(std::size_t leaf_node) const {
    const std::size_t leaf = leaf_node - leaves();
    return std::span(items_).subspan(places_[leaf], places_[leaf + 1] - places_[leaf]);
  }

  /// `place`: of the first item.
  void build(std::size_t node, std::span<const SmallBox> boxes, std::span<Centre> centres, std::size_t place,
             StopCheck& check) {
    check.after(1);
    if (is_leaf(node)) {
      places_[node - leaves()] = static_cast<std::uint32_t>(place);
      for (const Centre& centre : centres) {
        items_[place] = {boxes[centre.number], centre.number};
        nodes_[node].include(items_[place++].box);
      }
      return;
    }
    const std::size_t half = centres.size() / 2;
    halve(centres, half, check);
    const auto build_low = [&](StopCheck& own) { build(2 * node, boxes, centres.first(half), place, own); };
    const auto build_high = [&](StopCheck& own) {
      build(2 * node + 1, boxes, centres.subspan(half), place + half, own);
    };
    if (centres.size() < least_for_threads) {
      build_low(check);
      build_high(check);
    } else {
      StopCheck other(stop_, seeking);
      sim::parallel_invoke([&] { build_low(check); }, [&] { build_high(other); });
    }
    nodes_[node].include(nodes_[2 * node]);
    nodes_[node].include(nodes_[2 * node + 1]);
  }

  /// Puts the lower centres first, along the axis in which they differ most.
  static void halve(std::span<Centre> centres, std::size_t half, StopCheck& check) {
    SmallBox box;
    for (const Centre& centre : centres) box.include({centre.doubled, centre.doubled});
    const glm::vec3 size = box.high - box.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::nth_element(centres.begin(), centres.begin() + static_cast<std::ptrdiff_t>(half), centres.end(),
                     [&](const Centre& a, const Centre& b) {
                       check.after(1);
                       return a.doubled[axis] < b.doubled[axis];
                     });
  }

  /// Adds the pairs of the leaf `from` with the leaves below a node.
  void descend(std::size_t top, std::size_t from, StopCheck& check, std::vector<BoxPair>& pairs) const {
    const SmallBox& box = nodes_[from];
    std::array<std::size_t, 64> waiting;
    std::size_t count = 0;
    waiting[count++] = top;
    while (count > 0) {
      const std::size_t node = waiting[--count];
      if (!touch(nodes_[node], box)) continue;
      check.add(1);
      if (is_leaf(node)) {
        match(node, from, check, pairs);
      } else if (nodes_[node].longest_side() >= box.longest_side() || is_near(node, from)) {
        waiting[count++] = 2 * node + 1;
        waiting[count++] = 2 * node;
      }
    }
  }

  /// Whether a node that is smaller than the leaf `from` can have partners of its items.
  [[nodiscard]] bool is_near(std::size_t node, std::size_t from) const {
    const SmallBox& small = nodes_[node];
    const Box box = units_.large(small);
    return std::ranges::any_of(
        items_of(from), [&](const Item& item) { return touch(item.box, small) && tests_.near(item.number, box); });
  }

  void match(std::size_t leaf, std::size_t from, StopCheck& check, std::vector<BoxPair>& pairs) const {
    const std::span<const Item> others = items_of(leaf);
    const std::span<const Item> own = items_of(from);
    for (std::size_t i = 0; i < own.size(); ++i) {
      if (!touch(own[i].box, nodes_[leaf])) continue;
      for (std::size_t j = leaf == from ? i + 1 : 0; j < others.size(); ++j) {
        if (!touch(own[i].box, others[j].box)) continue;
        check.add(work_of_match);
        const std::uint32_t low = std::min(own[i].number, others[j].number);
        const std::uint32_t high = std::max(own[i].number, others[j].number);
        if (tests_.match(low, high)) pairs.push_back({low, high});
      }
    }
  }

  const BoxPairTests& tests_;
  std::stop_token stop_;
  SmallUnits units_;
  std::size_t depth_ = 0;
  std::vector<SmallBox> nodes_ = {};
  std::vector<std::uint32_t> places_ = {};  ///< of each leaf's first item, and the number of items
  std::vector<Item> items_ = {};
};

}  // namespace

std::vector<BoxPair> box_pairs(std::size_t boxes, const BoxPairTests& tests, const std::stop_token& stop) {
  const PairTree tree(boxes, tests, stop);
  const std::size_t in_a_part = std::min(tree.leaves(), leaves_in_a_part);
  std::vector<std::vector<BoxPair>> of_parts(tree.leaves() / in_a_part);
  sim::parallel_for(ParallelRange(0, of_parts.size(), 1), [&](const ParallelRange& parts) {
    StopCheck check(stop, seeking);
    for (std::size_t part = parts.begin(); part != parts.end(); ++part)
      for (std::size_t leaf = part * in_a_part; leaf < (part + 1) * in_a_part; ++leaf) {
        if (check.requested_after(1)) return;
        tree.add_pairs(leaf, check, of_parts[part]);
      }
  });
  StopCheck check(stop, seeking);
  check.now();
  std::vector<BoxPair> pairs;
  for (const auto& some : of_parts) pairs.insert(pairs.end(), some.begin(), some.end());
  std::sort(pairs.begin(), pairs.end(), [&](const BoxPair& a, const BoxPair& b) {
    check.after(1);
    return a < b;
  });
  return pairs;
}

}  // namespace detp::sim
