#include "octree_nodes.hpp"

#include <array>

#include "detp/sim/memory.hpp"
#include "disc_box.hpp"
#include "indexed_search.hpp"

namespace detp::sim {
namespace {

class Builder {
 public:
  Builder(const Problem& problem, int depth, Insertion insertion, const std::stop_token& stop)
      : problem_(problem), insertion_(insertion), stop_(stop) {
    const Box box = index_box(problem);
    const glm::dvec3 size = box.size();
    tree_.depth = depth;
    tree_.cube = {box.low, box.low + glm::dvec3{std::max({size.x, size.y, size.z})}};
  }

  OctreeNodes build() && {
    std::vector<std::uint32_t> all(problem_.discs.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    tree_.nodes.emplace_back();
    build(0, tree_.cube, 0, all);
    tree_.nodes.shrink_to_fit();
    tree_.references.shrink_to_fit();
    return std::move(tree_);
  }

 private:
  void build(std::uint32_t node, const Box& box, int level, const std::vector<std::uint32_t>& discs) {
    if (stop_.stop_requested()) return;
    if (level == tree_.depth) {
      tree_.nodes[node].first = static_cast<std::uint32_t>(tree_.references.size());
      tree_.nodes[node].count = static_cast<std::uint32_t>(discs.size());
      tree_.references.insert(tree_.references.end(), discs.begin(), discs.end());
      require_room();
      return;
    }
    std::array<std::vector<std::uint32_t>, 8> parts = split(box, discs);
    tree_.nodes[node].first = static_cast<std::uint32_t>(tree_.nodes.size());
    for (unsigned octant = 0; octant < 8; ++octant)
      if (!parts[octant].empty()) {
        tree_.nodes[node].octants |= static_cast<std::uint8_t>(1U << octant);
        tree_.nodes.emplace_back();
        tree_.placements += parts[octant].size();
      }
    std::uint32_t child = tree_.nodes[node].first;
    for (unsigned octant = 0; octant < 8; ++octant)
      if (!parts[octant].empty()) {
        build(child++, octant_of(box, octant), level + 1, parts[octant]);
        parts[octant] = {};
      }
  }

  /// The discs of each octant. Only those octants are looked at that the disc's bounds reach into.
  std::array<std::vector<std::uint32_t>, 8> split(const Box& box, const std::vector<std::uint32_t>& discs) const {
    std::array<std::vector<std::uint32_t>, 8> parts;
    const glm::dvec3 middle = box.centre();
    for (const std::uint32_t i : discs) {
      const Box reach = bounds(problem_.discs[i], problem_.slack);
      for (unsigned octant = 0; octant < 8; ++octant) {
        bool reached = true;
        for (int axis = 0; axis < 3; ++axis)
          reached =
              reached && (octant >> axis & 1 ? reach.high[axis] >= middle[axis] : reach.low[axis] <= middle[axis]);
        if (reached && (insertion_ == Insertion::bounding_box ||
                        overlaps(problem_.discs[i], octant_of(box, octant), problem_.slack)))
          parts[octant].push_back(i);
      }
    }
    return parts;
  }

  void require_room() const {
    require_memory("the octree", static_cast<double>(tree_.references.size()) * sizeof(std::uint32_t) +
                                     static_cast<double>(tree_.nodes.size()) * sizeof(OctreeNode));
    if (tree_.references.size() >= UINT32_MAX || tree_.nodes.size() >= UINT32_MAX)
      throw std::length_error("the octree would hold 2^32 or more references; a smaller depth is needed");
  }

  const Problem& problem_;
  Insertion insertion_;
  const std::stop_token& stop_;
  OctreeNodes tree_;
};

}  // namespace

Box octant_of(const Box& box, unsigned octant) {
  const glm::dvec3 middle = box.centre();
  Box part = box;
  for (int axis = 0; axis < 3; ++axis) (octant >> axis & 1 ? part.low : part.high)[axis] = middle[axis];
  return part;
}

OctreeNodes build_octree(const Problem& problem, int depth, Insertion insertion, const std::stop_token& stop) {
  return Builder(problem, depth, insertion, stop).build();
}

}  // namespace detp::sim
