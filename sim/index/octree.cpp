#include <bit>

#include "detp/sim/search/run_memory.hpp"
#include "indexed_search.hpp"
#include "octree_descent.hpp"
#include "octree_nodes.hpp"
#include "octree_walk.hpp"

namespace detp::sim {
namespace {

class Octree {
 public:
  Octree(const Problem& problem, const OctreeParameters& parameters, const IndexVariant& variant,
         const std::stop_token& stop)
      : slack_(problem.slack()),
        traversal_(parameters.traversal),
        tree_(build_octree(problem, parameters.depth, variant.insertion, stop)),
        walk_(tree_.cube, tree_.depth) {
    if (traversal_ == Traversal::neighbour_links) linked_ = link_neighbours(tree_, stop);
  }

  [[nodiscard]] IndexSize size() const {
    return {.nodes = tree_.nodes.size(),
            .references = tree_.references.size(),
            .placements = tree_.placements,
            .bytes = tree_bytes() + linked_.size() * sizeof(LinkedNode),
            .building_bytes = linking_bytes()};
  }

  [[nodiscard]] std::span<const std::uint32_t> references() const { return tree_.references; }

  void visit_nodes(const VisitNode& visit) const { visit_nodes(0, tree_.cube, 0, visit); }

  template <class Search>
  void trace(const Ray& traced, std::uint32_t ray, Search& search) const {
    const ClippedRay clipped(traced);
    const RayInterval interval = clipped.inside({tree_.cube.low - slack_, tree_.cube.high + slack_});
    if (interval.empty()) return;
    const OctreeDescent descent(tree_, clipped, slack_);
    switch (traversal_) {
      case Traversal::top_down:
        return descent.visit_all(ray, search);
      case Traversal::front_to_back:
        return descent.visit_in_order(ray, search);
      case Traversal::restart:
        return walk_.for_each_leaf(traced, clipped, interval,
                                   [&](const Leaf& place, int) { return search_from_root(place, ray, search); });
      case Traversal::neighbour_links: {
        std::uint32_t number = 0;
        return walk_.for_each_leaf(traced, clipped, interval, [&](const Leaf& place, int face) {
          return search_along_link(number, place, face, ray, search);
        });
      }
    }
  }

 private:
  void visit_nodes(std::uint32_t number, const Box& box, int level, const VisitNode& visit) const {
    const OctreeNode& node = tree_.nodes[number];
    visit({box, level, level == tree_.depth, node.count});
    if (level < tree_.depth)
      for_each_child(node, box,
                     [&](std::uint32_t child, const Box& part) { visit_nodes(child, part, level + 1, visit); });
  }

  /// Peak bytes while the tree is built or linked. Linking keeps, for each linked node, the number of the tree's node
  /// from which it was made.
  [[nodiscard]] double linking_bytes() const {
    return std::max(tree_.building_bytes,
                    static_cast<double>(tree_bytes()) +
                        static_cast<double>(linked_.size()) * (sizeof(LinkedNode) + sizeof(no_node)));
  }

  [[nodiscard]] std::size_t tree_bytes() const {
    return tree_.nodes.size() * sizeof(OctreeNode) + tree_.references.size() * sizeof(std::uint32_t);
  }

  /// Descends from the root towards `place`. Tests the ray against the discs of the leaf there, and returns the leaf's
  /// cube; if an omitted octant contains `place`, only returns the octant's cube.
  template <class Search>
  LeafCube search_from_root(const Leaf& place, std::uint32_t ray, Search& search) const {
    std::uint32_t number = 0;
    int below = tree_.depth;
    search.visit(&Counts<std::uint64_t>::nodes);
    for (; below > 0; --below) {
      const unsigned octant = octant_of(place, below - 1);
      const unsigned octants = tree_.nodes[number].octants;
      if ((octants >> octant & 1) == 0) return cube_around(place, std::int64_t{1} << (below - 1));
      number = tree_.nodes[number].first + static_cast<std::uint32_t>(std::popcount(octants & ((1U << octant) - 1)));
      search.visit(&Counts<std::uint64_t>::nodes);
    }
    search.test(ray, tree_.references_in(tree_.nodes[number]));
    return cube_around(place, 1);
  }

  /// Moves from node `number` (the root, a leaf or an empty octant) across `face`, then down to the leaf or empty
  /// octant at `place`. Tests the ray against that node's discs, sets `number` to the node, and returns its cube.
  template <class Search>
  LeafCube search_along_link(std::uint32_t& number, const Leaf& place, int face, std::uint32_t ray,
                             Search& search) const {
    if (face >= 0) number = linked_[number].links[static_cast<std::size_t>(face)];
    search.visit(&Counts<std::uint64_t>::nodes);
    while (linked_[number].inner) {
      number = linked_[number].first + octant_of(place, tree_.depth - linked_[number].level - 1);
      search.visit(&Counts<std::uint64_t>::nodes);
    }
    const LinkedNode& leaf = linked_[number];
    search.test(ray, std::span(tree_.references).subspan(leaf.first, leaf.count));
    return cube_around(place, std::int64_t{1} << (tree_.depth - leaf.level));
  }

  double slack_;
  Traversal traversal_;
  OctreeNodes tree_;
  LeafWalk walk_;
  std::vector<LinkedNode> linked_;  ///< only for neighbour_links
};

}  // namespace

IndexSize inspect_octree(const Problem& problem, const OctreeParameters& parameters, const IndexVariant& variant,
                         const VisitNode& visit, const std::stop_token& stop) {
  check({Technique::octree, parameters});
  const Octree octree(problem, parameters, variant, stop);
  octree.visit_nodes(visit);
  return octree.size();
}

std::unique_ptr<Index> index_octree(const Problem& problem, const OctreeParameters& parameters,
                                    const IndexVariant& variant, const RunOptions& options) {
  check({Technique::octree, parameters});
  return std::make_unique<TracedIndex<Octree>>("the octree", problem, options, variant.mailboxing, parameters, variant);
}

std::unique_ptr<Index> prepare_octree(const Problem& problem, const Parameters& parameters, const RunOptions& options) {
  return index_octree(problem, std::get<OctreeParameters>(parameters), {}, options);
}

}  // namespace detp::sim
