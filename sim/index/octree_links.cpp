#include "octree_links.hpp"

#include <algorithm>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stop_check.hpp"

namespace detp::sim {
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
