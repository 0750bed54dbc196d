#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <stop_token>

#include "detp/sim/base/function_ref.hpp"
#include "detp/sim/base/page_pool.hpp"
#include "facet.hpp"

namespace detp::sim {

/// A box in single precision.
struct ItemBox {
  glm::vec3 low;
  glm::vec3 high;
};

/// A tree of boxes over items, with eight children a node, for rays and for points. Works in single precision: with coordinates up to 1.5 and rays up
/// to 3 long, the faces of a box are met as if they were displaced by less than 1e-6, so boxes need that margin.
///
/// Each node is split where the expected cost of a ray is least (surface-area heuristic) among 16 bins along each axis: Wald, "On fast Construction of
/// SAH-based Bounding Volume Hierarchies", IEEE Symposium on Interactive Ray Tracing, 2007. The tree does not depend on the number of threads.
class ItemTree {
 public:
  /// Throws Stopped ("stopped while " + doing) if a stop was requested.
  ItemTree(std::span<const ItemBox> boxes, const std::stop_token& stop, const char* doing);

  /// Calls test(item) for the items whose box the ray meets, and for some others, the nearer nodes first. It returns the ray's length from then on.
  void along(const glm::vec3& origin, const glm::vec3& direction, float length,
             FunctionRef<float(std::uint32_t item)> test) const;

  /// Calls visit(item) for the items whose box has a point within `reach` of the point, and for some others, in no particular order.
  void near(const glm::vec3& point, float reach, FunctionRef<void(std::uint32_t item)> visit) const;

  static constexpr std::size_t width = 8;

  /// Boxes of up to eight children, and what is in them. A box without a child holds nothing.
  struct Node {
    alignas(64) float planes[6][width];  ///< least x, y, z, then largest
    std::uint32_t first[width];          ///< number of a node, or place of the first item
    std::uint8_t items[width];           ///< in a leaf; 0: the child is a node
  };

 private:
  UnsetVector<Node> nodes_;
  UnsetVector<std::uint32_t> items_;  ///< leaf by leaf
};

/// A tree over facets, whose corners have the coordinates own(corner) in it. Boxes are `margin` larger on each side. Throws Stopped if a stop
/// was requested.
[[nodiscard]] ItemTree facet_tree(std::span<const Facet> facets, FunctionRef<glm::dvec3(const glm::dvec3&)> own,
                                  float margin, const std::stop_token& stop);

}  // namespace detp::sim
