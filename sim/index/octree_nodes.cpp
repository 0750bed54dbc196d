#include "octree_nodes.hpp"

#include <algorithm>
#include <array>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/disc_box.hpp"
#include "indexed_search.hpp"

namespace detp::sim {
namespace {

class OctreeBuilder {
 public:
  OctreeBuilder(const Problem& problem, int depth, Insertion insertion, const std::stop_token& stop)
      : problem_(problem), insertion_(insertion), check_(stop, "building the octree") {
    check_.now();
    const Box box = index_box(problem);
    const glm::dvec3 size = box.size();
    tree_.depth = depth;
    tree_.cube = {box.low, box.low + glm::dvec3{std::max({size.x, size.y, size.z})}};
  }

  OctreeNodes build() && {
    std::vector<std::uint32_t> all(problem_.discs().size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    tree_.nodes.emplace_back();
    listed_ = most_listed_ = all.size();
    build(0, tree_.cube, 0, all);
    tree_.building_bytes = needed();
    tree_.nodes.shrink_to_fit();
    tree_.references.shrink_to_fit();
    return std::move(tree_);
  }

 private:
  void build(std::uint32_t node, const Box& box, int level, const std::vector<std::uint32_t>& discs) {
    check_.after(1);
    if (level == tree_.depth) {
      tree_.nodes[node].first = static_cast<std::uint32_t>(tree_.references.size());
      tree_.nodes[node].count = static_cast<std::uint32_t>(discs.size());
      require_room(discs.size());
      tree_.references.insert(tree_.references.end(), discs.begin(), discs.end());
      return;
    }
    std::array<std::vector<std::uint32_t>, 8> parts = split(box, discs);
    for (const std::vector<std::uint32_t>& part : parts) listed_ += part.size();
    most_listed_ = std::max(most_listed_, listed_);
    require_room(0);
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
        listed_ -= parts[octant].size();
        parts[octant] = {};
      }
  }

  /// The discs of each octant. Tests a disc for overlap only with the octants that its bounds reach.
  std::array<std::vector<std::uint32_t>, 8> split(const Box& box, const std::vector<std::uint32_t>& discs) {
    std::array<std::vector<std::uint32_t>, 8> parts;
    const glm::dvec3 middle = box.centre();
    for (const std::uint32_t i : discs) {
      const Box reach = bounds(problem_.discs()[i], problem_.slack());
      for (unsigned octant = 0; octant < 8; ++octant) {
        bool reached = true;
        for (int axis = 0; axis < 3; ++axis)
          reached =
              reached && (octant >> axis & 1 ? reach.high[axis] >= middle[axis] : reach.low[axis] <= middle[axis]);
        if (reached && (insertion_ == Insertion::bounding_box ||
                        overlaps(problem_.discs()[i], octant_of(box, octant), problem_.slack())))
          parts[octant].push_back(i);
      }
      check_.after(8);
    }
    return parts;
  }

  /// Predicted bytes with `more` additional references. Includes the copy that trims the arrays at the end.
  [[nodiscard]] double needed(std::size_t more = 0) const {
    const std::size_t references = tree_.references.size() + more;
    return static_cast<double>(most_listed_) * sizeof(std::uint32_t) +
           std::max(grown_bytes(references, sizeof(std::uint32_t)),
                    2.0 * static_cast<double>(references) * sizeof(std::uint32_t)) +
           grown_bytes(tree_.nodes.size(), sizeof(OctreeNode));
  }

  void require_room(std::size_t more) const {
    require_memory("the octree", needed(more));
    if (tree_.references.size() + more >= UINT32_MAX || tree_.nodes.size() >= UINT32_MAX)
      throw std::length_error("the octree would hold 2^32 or more references; a smaller depth is needed");
  }

  const Problem& problem_;
  Insertion insertion_;
  StopCheck check_;
  std::size_t listed_ = 0;       ///< discs in the lists of unfinished nodes
  std::size_t most_listed_ = 0;  ///< the largest value of listed_
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
  return OctreeBuilder(problem, depth, insertion, stop).build();
}

namespace {

/// Lays out the nodes, without links.
std::vector<LinkedNode> nodes_without_links(const OctreeNodes& tree, StopCheck& check) {
  const auto inner = static_cast<std::size_t>(
      std::count_if(tree.nodes.begin(), tree.nodes.end(), [](const OctreeNode& node) { return node.octants != 0; }));
  const std::size_t total = 1 + 8 * inner;
  require_memory("the octree with its links", static_cast<double>(total) * (sizeof(LinkedNode) + sizeof(no_node)));
  if (total >= no_node)
    throw std::length_error("the octree would have 2^32 or more linked nodes; a smaller depth is needed");
  std::vector<LinkedNode> nodes;
  std::vector<std::uint32_t> source{0};  // the tree's node for each of `nodes`; no_node for an omitted octant
  nodes.reserve(total);
  source.reserve(total);
  const LinkedNode unlinked{.links = {no_node, no_node, no_node, no_node, no_node, no_node}};
  nodes.push_back(unlinked);
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    check.after(1);
    if (source[i] == no_node) continue;
    const OctreeNode& from = tree.nodes[source[i]];
    nodes[i].inner = from.octants != 0;
    nodes[i].first = nodes[i].inner ? static_cast<std::uint32_t>(nodes.size()) : from.first;
    nodes[i].count = from.count;
    if (!nodes[i].inner) continue;
    LinkedNode child = unlinked;
    child.level = static_cast<std::uint8_t>(nodes[i].level + 1);
    std::uint32_t next = from.first;
    for (unsigned octant = 0; octant < 8; ++octant) {
      nodes.push_back(child);
      source.push_back(from.octants >> octant & 1 ? next++ : no_node);
    }
  }
  return nodes;
}

/// Links a node's children to each other and, by the node's own links, across its faces.
void link_children(std::vector<LinkedNode>& nodes, const LinkedNode& node) {
  for (unsigned octant = 0; octant < 8; ++octant)
    for (unsigned face = 0; face < 6; ++face) {
      const unsigned mirrored = octant ^ 1U << face / 2;
      const bool sibling = (octant >> face / 2 & 1) != (face & 1);
      std::uint32_t across = sibling ? node.first + mirrored : node.links[face];
      if (!sibling && across != no_node && nodes[across].inner) across = nodes[across].first + mirrored;
      nodes[node.first + octant].links[face] = across;
    }
}

}  // namespace

std::vector<LinkedNode> link_neighbours(const OctreeNodes& tree, const std::stop_token& stop) {
  StopCheck check(stop, "linking the octree");
  std::vector<LinkedNode> nodes = nodes_without_links(tree, check);
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].inner) link_children(nodes, nodes[i]);
    check.after(6);
  }
  return nodes;
}

}  // namespace detp::sim
