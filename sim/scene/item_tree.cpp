#include "item_tree.hpp"

#include <hwy/base.h>

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <limits>
#include <vector>

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stop_check.hpp"

namespace detp::sim {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr ItemBox empty_box{glm::vec3(infinite), glm::vec3(-infinite)};
constexpr std::uint32_t most_in_leaf = 4;
constexpr std::size_t bins = 16;
constexpr int most_depth = 48;                        // deeper nodes are halved, so that the depth is bounded
constexpr std::uint32_t least_for_threads = 1 << 12;  // items

HWY_INLINE void include(ItemBox& box, const ItemBox& other) {
  box.low = glm::min(box.low, other.low);
  box.high = glm::max(box.high, other.high);
}

/// Half of the surface.
float area(const ItemBox& box) {
  const glm::vec3 side = box.high - box.low;
  return side.x < 0 ? 0 : side.x * side.y + side.y * side.z + side.z * side.x;
}

struct BinaryItemNode {
  ItemBox box;
  std::uint32_t first;
  std::uint32_t count;
  std::uint32_t right;  ///< number of the right child, 0 for a leaf; the left child is the next node
};

/// Writes a binary tree, then one with eight children a node.
class ItemTreeBuilder {
 public:
  ItemTreeBuilder(std::span<const ItemBox> boxes, UnsetVector<std::uint32_t>& items, const std::stop_token& stop,
                  const char* doing)
      : boxes_(boxes), items_(items), stop_(stop), doing_(doing), binary_(2 * boxes.size()) {
    for (std::uint32_t i = 0; i < items.size(); ++i) items[i] = i;
    StopCheck check(stop, doing);
    split(0, static_cast<std::uint32_t>(boxes.size()), 0, 0, check);
    check.now();
  }

  void widen(UnsetVector<ItemTree::Node>& nodes) {
    nodes.reserve(boxes_.size() / 4 + 1);
    nodes.push_back({});
    widen(0, 0, nodes);
  }

 private:
  struct Split {
    float cost = infinite;
    int axis = 0;
    std::size_t bin = 0;  ///< the first of the right child
  };
  struct Bin {
    ItemBox box = empty_box;
    std::uint32_t count = 0;
  };
  /// Of the items' doubled centres, along each axis.
  struct Bins {
    glm::vec3 low;
    glm::vec3 scale;
    [[nodiscard]] std::size_t of(const ItemBox& box, int axis) const {
      const float place = (box.low[axis] + box.high[axis] - low[axis]) * scale[axis];
      return std::min(static_cast<std::size_t>(std::max(place, 0.0F)), bins - 1);
    }
  };

  /// The nodes below `number` have the numbers after it, fewer than 2 `count`.
  void split(std::uint32_t first, std::uint32_t count, std::uint32_t number, int depth, StopCheck& check) {
    const std::span<std::uint32_t> items = std::span(items_).subspan(first, count);
    check.after(std::min<std::uint64_t>(count, StopCheck::most_work));
    BinaryItemNode& node = binary_[number];
    ItemBox centres = empty_box;
    node = {empty_box, first, count, 0};
    for (const std::uint32_t item : items) {
      const ItemBox& box = boxes_[item];
      include(node.box, box);
      const glm::vec3 centre = box.low + box.high;
      include(centres, {centre, centre});
    }
    if (count <= 1) return;
    const std::uint32_t left = part(items, node.box, centres, depth);
    if (left == 0) return;
    node.right = number + 2 * left;
    const auto below = [&](std::uint32_t from, std::uint32_t so_many, std::uint32_t at, StopCheck& own) {
      split(from, so_many, at, depth + 1, own);
    };
    if (count < least_for_threads) {
      below(first, left, number + 1, check);
      below(first + left, count - left, node.right, check);
    } else {
      StopCheck other(stop_, doing_);
      sim::parallel_invoke([&] { below(first, left, number + 1, check); },
                           [&] { below(first + left, count - left, node.right, other); });
    }
  }

  /// Puts the items of the left child first, and returns their number; 0 for a leaf.
  std::uint32_t part(std::span<std::uint32_t> items, const ItemBox& box, const ItemBox& centres, int depth) const {
    const auto count = static_cast<std::uint32_t>(items.size());
    const glm::vec3 extent = centres.high - centres.low;
    Bins into{centres.low, glm::vec3(0)};
    for (int axis = 0; axis < 3; ++axis)
      if (extent[axis] > 1e-30F) into.scale[axis] = static_cast<float>(bins) * 0.99999F / extent[axis];
    const Split best = depth < most_depth ? best_split(items, into) : Split{};
    const float whole = area(box);
    const bool leaf = count <= most_in_leaf && !(best.cost + whole < whole * static_cast<float>(count));
    if (leaf) return 0;
    if (best.cost == infinite) return halved(items, extent);
    const auto goes_left = [&](std::uint32_t item) { return into.of(boxes_[item], best.axis) < best.bin; };
    return static_cast<std::uint32_t>(std::partition(items.begin(), items.end(), goes_left) - items.begin());
  }

  /// The split with the least area times items (a test of an item costs as much as one of a node's box); an infinite cost if all centres are in one bin of each axis.
  [[nodiscard]] Split best_split(std::span<const std::uint32_t> items, const Bins& into) const {
    std::array<std::array<Bin, bins>, 3> all;
    for (const std::uint32_t item : items)
      for (int axis = 0; axis < 3; ++axis) {
        Bin& bin = all[static_cast<std::size_t>(axis)][into.of(boxes_[item], axis)];
        include(bin.box, boxes_[item]);
        ++bin.count;
      }
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
      if (into.scale[axis] == 0) continue;
      const auto& of_axis = all[static_cast<std::size_t>(axis)];
      std::array<float, bins> right_cost{};
      Bin right;
      for (std::size_t bin = bins - 1; bin > 0; --bin) {
        include(right.box, of_axis[bin].box);
        right.count += of_axis[bin].count;
        right_cost[bin] = right.count == 0 ? infinite : area(right.box) * static_cast<float>(right.count);
      }
      Bin left;
      for (std::size_t bin = 1; bin < bins; ++bin) {
        include(left.box, of_axis[bin - 1].box);
        left.count += of_axis[bin - 1].count;
        if (left.count == 0) continue;
        const float cost = area(left.box) * static_cast<float>(left.count) + right_cost[bin];
        if (cost < best.cost) best = {cost, axis, bin};
      }
    }
    return best;
  }

  [[nodiscard]] std::uint32_t halved(std::span<std::uint32_t> items, const glm::vec3& extent) const {
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const auto half = static_cast<std::ptrdiff_t>(items.size() / 2);
    std::nth_element(items.begin(), items.begin() + half, items.end(), [&](std::uint32_t a, std::uint32_t b) {
      const float x = boxes_[a].low[axis] + boxes_[a].high[axis];
      const float y = boxes_[b].low[axis] + boxes_[b].high[axis];
      return x < y || (x == y && a < b);
    });
    return static_cast<std::uint32_t>(half);
  }

  /// Fills in node `place` with the descendants of a binary node: of its children, the largest are replaced by theirs.
  void widen(std::uint32_t number, std::size_t place, UnsetVector<ItemTree::Node>& nodes) {
    std::array<std::uint32_t, ItemTree::width> children{number};
    std::size_t count = 1;
    while (count < ItemTree::width) {
      std::size_t largest = count;
      float most = -1;
      for (std::size_t i = 0; i < count; ++i)
        if (const BinaryItemNode& child = binary_[children[i]]; child.right != 0 && area(child.box) > most) {
          largest = i;
          most = area(child.box);
        }
      if (largest == count) break;
      const std::uint32_t opened = children[largest];
      children[largest] = opened + 1;
      children[count++] = binary_[opened].right;
    }
    for (std::size_t i = 0; i < ItemTree::width; ++i) {
      const BinaryItemNode child = i < count ? binary_[children[i]] : BinaryItemNode{empty_box, 0, 0, 0};
      const bool is_node = child.right != 0;
      const auto first = is_node ? static_cast<std::uint32_t>(nodes.size()) : child.first;
      if (is_node) nodes.push_back({});
      ItemTree::Node& node = nodes[place];
      for (int axis = 0; axis < 3; ++axis) {
        node.planes[axis][i] = child.box.low[axis];
        node.planes[axis + 3][i] = child.box.high[axis];
      }
      node.first[i] = first;
      node.items[i] = is_node ? 0 : static_cast<std::uint8_t>(child.count);
    }
    for (std::size_t i = 0; i < count; ++i)
      if (binary_[children[i]].right != 0) widen(children[i], nodes[place].first[i], nodes);
  }

  std::span<const ItemBox> boxes_;
  UnsetVector<std::uint32_t>& items_;
  const std::stop_token& stop_;
  const char* doing_;
  UnsetVector<BinaryItemNode> binary_;
};

}  // namespace

ItemTree::ItemTree(std::span<const ItemBox> boxes, const std::stop_token& stop, const char* doing)
    : items_(boxes.size()) {
  if (boxes.empty()) return;
  ItemTreeBuilder(boxes, items_, stop, doing).widen(nodes_);
}

ItemTree facet_tree(std::span<const Facet> facets, FunctionRef<glm::dvec3(const glm::dvec3&)> own, float margin,
                    const std::stop_token& stop) {
  constexpr const char* doing = "building a tree over the scene's triangles";
  std::vector<ItemBox> boxes;
  boxes.reserve(facets.size());
  StopCheck check(stop, doing);
  for_each_checked(facets, check, [&](const Facet& facet) {
    Box box;
    for (const glm::dvec3& corner : {facet.corner, facet.corner + facet.first, facet.corner + facet.second})
      box.include(own(corner));
    boxes.push_back({glm::vec3(box.low) - margin, glm::vec3(box.high) + margin});
  });
  return {boxes, stop, doing};
}

}  // namespace detp::sim
