#include "item_tree.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detp/sim/scene/item_tree_walk.cpp"
#include <hwy/foreach_target.h>
// highway.h must come after foreach_target.h.
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace detp::sim {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using BoxLanes = hn::CappedTag<float, ItemTree::width>;

/// A node, or items of a leaf, on the stack of a walk.
struct Waiting {
  float distance;
  std::uint32_t first;
  std::uint32_t items;
};

/// Nodes have at most eight children, and the binary tree a depth of at most 48 + 32.
constexpr std::size_t most_waiting = (ItemTree::width - 1) * 80 + 1;

/// Bits of the boxes for which `met` of the first lane is true. Calls it for each vector of boxes.
template <class Met>
HWY_INLINE unsigned boxes_met(const Met& met) {
  unsigned bits = 0;
  for (std::size_t lane = 0; lane < ItemTree::width; lane += hn::Lanes(BoxLanes())) {
    std::uint8_t stored[8] = {};
    hn::StoreMaskBits(BoxLanes(), met(lane), stored);
    bits |= static_cast<unsigned>(stored[0]) << lane;
  }
  return bits;
}

void WalkAlong(std::span<const ItemTree::Node> nodes, const std::uint32_t* items, const glm::vec3& origin,
               const glm::vec3& direction, float length, FunctionRef<float(std::uint32_t)> test) {
  constexpr float least = 1e-30F;  // smaller components would make inverses infinite
  const BoxLanes lanes;
  glm::vec3 inverse;
  std::size_t near[3];  // where in a node the planes are through which the ray enters boxes
  std::size_t far[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float size = std::max(std::abs(direction[axis]), least);
    const bool falls = std::signbit(direction[axis]);
    inverse[axis] = 1 / std::copysign(size, direction[axis]);
    const auto low = static_cast<std::size_t>(axis) * ItemTree::width;
    near[axis] = falls ? low + 3 * ItemTree::width : low;
    far[axis] = falls ? low : low + 3 * ItemTree::width;
  }
  const auto by_x = hn::Set(lanes, inverse.x);
  const auto by_y = hn::Set(lanes, inverse.y);
  const auto by_z = hn::Set(lanes, inverse.z);
  const auto from_x = hn::Set(lanes, origin.x * inverse.x);
  const auto from_y = hn::Set(lanes, origin.y * inverse.y);
  const auto from_z = hn::Set(lanes, origin.z * inverse.z);
  std::array<Waiting, most_waiting> waiting;
  std::size_t count = 0;
  Waiting next{0, 0, 0};
  while (true) {
    if (next.items > 0) {
      for (std::uint32_t i = 0; i < next.items; ++i) length = test(items[next.first + i]);
    } else {
      const ItemTree::Node& node = nodes[next.first];
      const float* const planes = &node.planes[0][0];
      alignas(32) float entries[ItemTree::width];
      unsigned met = boxes_met([&](std::size_t lane) HWY_ATTR {
        const float* const some = planes + lane;
        const auto enter_x = hn::MulSub(hn::Load(lanes, some + near[0]), by_x, from_x);
        const auto enter_y = hn::MulSub(hn::Load(lanes, some + near[1]), by_y, from_y);
        const auto enter_z = hn::MulSub(hn::Load(lanes, some + near[2]), by_z, from_z);
        const auto leave_x = hn::MulSub(hn::Load(lanes, some + far[0]), by_x, from_x);
        const auto leave_y = hn::MulSub(hn::Load(lanes, some + far[1]), by_y, from_y);
        const auto leave_z = hn::MulSub(hn::Load(lanes, some + far[2]), by_z, from_z);
        const auto enter = hn::Max(hn::Max(enter_x, enter_y), hn::Max(enter_z, hn::Zero(lanes)));
        const auto leave = hn::Min(hn::Min(leave_x, leave_y), hn::Min(leave_z, hn::Set(lanes, length)));
        hn::Store(enter, lanes, entries + lane);
        return hn::Le(enter, leave);
      });
      if (met != 0) {
        // The nearest is next; the others wait, the nearer ones above.
        const auto waiting_for = [&](std::size_t child) {
          return Waiting{entries[child], node.first[child], node.items[child]};
        };
        next = waiting_for(static_cast<std::size_t>(std::countr_zero(met)));
        const std::size_t bottom = count;
        for (met &= met - 1; met != 0; met &= met - 1) {
          Waiting other = waiting_for(static_cast<std::size_t>(std::countr_zero(met)));
          if (other.distance < next.distance) std::swap(other, next);
          std::size_t place = count++;
          for (; place > bottom && waiting[place - 1].distance < other.distance; --place)
            waiting[place] = waiting[place - 1];
          waiting[place] = other;
        }
        continue;
      }
    }
    do {
      if (count == 0) return;
      next = waiting[--count];
    } while (next.distance > length);
  }
}

void WalkNear(std::span<const ItemTree::Node> nodes, const std::uint32_t* items, const glm::vec3& point, float reach,
              FunctionRef<void(std::uint32_t)> visit) {
  const BoxLanes lanes;
  const auto most = hn::Set(lanes, reach * reach * (1 + 1e-6F));
  std::array<std::uint32_t, most_waiting> waiting;
  std::size_t count = 0;
  waiting[count++] = 0;
  while (count > 0) {
    const ItemTree::Node& node = nodes[waiting[--count]];
    unsigned met = boxes_met([&](std::size_t lane) HWY_ATTR {
      auto square = hn::Zero(lanes);
      for (int axis = 0; axis < 3; ++axis) {
        const auto at = hn::Set(lanes, point[axis]);
        const auto below = hn::Sub(hn::Load(lanes, node.planes[axis] + lane), at);
        const auto above = hn::Sub(at, hn::Load(lanes, node.planes[axis + 3] + lane));
        const auto apart = hn::Max(hn::Zero(lanes), hn::Max(below, above));
        square = hn::MulAdd(apart, apart, square);
      }
      return hn::Le(square, most);
    });
    for (; met != 0; met &= met - 1) {
      const auto child = static_cast<std::size_t>(std::countr_zero(met));
      if (node.items[child] == 0) waiting[count++] = node.first[child];
      for (std::uint32_t i = 0; i < node.items[child]; ++i) visit(items[node.first[child] + i]);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace detp::sim
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace detp::sim {

HWY_EXPORT(WalkAlong);
HWY_EXPORT(WalkNear);

void ItemTree::along(const glm::vec3& origin, const glm::vec3& direction, float length,
                     FunctionRef<float(std::uint32_t item)> test) const {
  if (!nodes_.empty()) HWY_DYNAMIC_DISPATCH(WalkAlong)(nodes_, items_.data(), origin, direction, length, test);
}

void ItemTree::near(const glm::vec3& point, float reach, FunctionRef<void(std::uint32_t item)> visit) const {
  if (!nodes_.empty()) HWY_DYNAMIC_DISPATCH(WalkNear)(nodes_, items_.data(), point, reach, visit);
}

}  // namespace detp::sim
#endif
