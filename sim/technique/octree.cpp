#include <array>
#include <bit>
#include <cmath>

#include "indexed_search.hpp"
#include "octree_nodes.hpp"
#include "ray_box.hpp"
#include "techniques.hpp"

namespace detp::sim {
namespace {

class Octree {
 public:
  Octree(const Problem& problem, int depth, const IndexVariant& variant, const std::stop_token& stop)
      : problem_(problem),
        traversal_(variant.traversal),
        tree_(build_octree(problem, depth, variant.insertion, stop)) {}

  [[nodiscard]] IndexSize size() const {
    return {.nodes = tree_.nodes.size(),
            .references = tree_.references.size(),
            .placements = tree_.placements,
            .bytes = tree_.nodes.size() * sizeof(OctreeNode) + tree_.references.size() * sizeof(std::uint32_t)};
  }

  void show(const VisitNode& visit) const { show(0, tree_.cube, 0, visit); }

  template <class Search>
  void trace(std::uint32_t ray, Search& search) const {
    const ClippedRay clipped(problem_.rays[ray]);
    const Stretch stretch = clipped.inside(grown(tree_.cube));
    if (stretch.empty()) return;
    if (traversal_ == Traversal::restart)
      restart(ray, clipped, stretch, search);
    else
      enter(0, tree_.cube, 0, ray, clipped, search);
  }

 private:
  Box grown(const Box& box) const { return {box.low - problem_.slack, box.high + problem_.slack}; }

  template <class VisitChild>
  void for_each_child(const OctreeNode& node, const Box& box, const VisitChild& visit) const {
    std::uint32_t child = node.first;
    for (unsigned octant = 0; octant < 8; ++octant)
      if (node.octants >> octant & 1) visit(child++, octant_of(box, octant));
  }

  void show(std::uint32_t number, const Box& box, int level, const VisitNode& visit) const {
    const OctreeNode& node = tree_.nodes[number];
    visit({box, level, level == tree_.depth, node.count});
    if (level < tree_.depth)
      for_each_child(node, box, [&](std::uint32_t child, const Box& part) { show(child, part, level + 1, visit); });
  }

  template <class Search>
  void enter(std::uint32_t number, const Box& box, int level, std::uint32_t ray, const ClippedRay& clipped,
             Search& search) const {
    search.visit(&Counts<std::uint64_t>::nodes);
    const OctreeNode& node = tree_.nodes[number];
    if (level == tree_.depth) {
      search.test(ray, tree_.references_in(node));
      return;
    }
    for_each_child(node, box, [&](std::uint32_t child, const Box& part) {
      if (!clipped.inside(grown(part)).empty()) enter(child, part, level + 1, ray, clipped, search);
    });
  }

  /// Cubes of whole leaves: their lowest leaf and their side, both in leaves.
  using Leaf = std::array<std::int64_t, 3>;
  struct Cube {
    Leaf low;
    std::int64_t side;
  };

  /// From the root towards that place among the leaves: tests the discs of the leaf there, or finds the octant that was
  /// left out. What the ray may skip.
  template <class Search>
  Cube descend(const Leaf& place, std::uint32_t ray, Search& search) const {
    std::uint32_t number = 0;
    int below = tree_.depth;
    search.visit(&Counts<std::uint64_t>::nodes);
    for (; below > 0; --below) {
      unsigned octant = 0;
      for (int axis = 0; axis < 3; ++axis) octant |= static_cast<unsigned>(place[axis] >> (below - 1) & 1) << axis;
      const unsigned octants = tree_.nodes[number].octants;
      if ((octants >> octant & 1) == 0) break;
      number = tree_.nodes[number].first + static_cast<std::uint32_t>(std::popcount(octants & ((1U << octant) - 1)));
      search.visit(&Counts<std::uint64_t>::nodes);
    }
    if (below == 0) search.test(ray, tree_.references_in(tree_.nodes[number]));
    Cube cube{place, below == 0 ? 1 : std::int64_t{1} << (below - 1)};
    for (std::int64_t& low : cube.low) low -= low % cube.side;
    return cube;
  }

  Leaf leaf_at(const glm::dvec3& point, const Cube& within) const {
    const double side = tree_.cube.size().x / std::ldexp(1.0, tree_.depth);
    Leaf leaf{};
    for (int axis = 0; axis < 3; ++axis) {
      const double place = std::floor((point[axis] - tree_.cube.low[axis]) / side);
      const auto low = static_cast<double>(within.low[axis]);
      leaf[axis] = static_cast<std::int64_t>(std::clamp(place, low, low + static_cast<double>(within.side - 1)));
    }
    return leaf;
  }

  /// Goes from leaf to leaf as the grid does from cell to cell, and descends anew to each.
  template <class Search>
  void restart(std::uint32_t ray, const ClippedRay& clipped, const Stretch& stretch, Search& search) const {
    const std::int64_t leaves = std::int64_t{1} << tree_.depth;
    const double side = tree_.cube.size().x / static_cast<double>(leaves);
    const glm::dvec3& direction = problem_.rays[ray].direction;
    Leaf place = leaf_at(clipped.origin + stretch.from * direction, {{}, leaves});
    for (;;) {
      const Cube cube = descend(place, ray, search);
      int next = 0;
      double leave = unbounded;
      for (int axis = 0; axis < 3; ++axis) {
        if (std::isinf(clipped.inverse[axis])) continue;
        const auto plane = static_cast<double>(cube.low[axis] + (clipped.inverse[axis] > 0 ? cube.side : 0));
        const double t = (tree_.cube.low[axis] + plane * side - clipped.origin[axis]) * clipped.inverse[axis];
        if (t < leave) {
          leave = t;
          next = axis;
        }
      }
      if (!(leave < stretch.to)) return;
      place = leaf_at(clipped.origin + leave * direction, cube);
      place[next] = cube.low[next] + (clipped.inverse[next] > 0 ? cube.side : -1);
      if (place[next] < 0 || place[next] >= leaves) return;
    }
  }

  const Problem& problem_;
  Traversal traversal_;
  OctreeNodes tree_;
};

}  // namespace

IndexSize inspect_octree(const Problem& problem, const OctreeParameters& parameters, const IndexVariant& variant,
                         const VisitNode& visit) {
  check({Technique::octree, parameters});
  const Octree octree(problem, parameters.depth, variant, {});
  octree.show(visit);
  return octree.size();
}

Outcome search_octree(const Problem& problem, const OctreeParameters& parameters, const IndexVariant& variant,
                      const RunOptions& options) {
  check({Technique::octree, parameters});
  check_options(options, problem);
  Outcome outcome;
  Stopwatch watch;
  const Octree octree(problem, parameters.depth, variant, options.stop);
  outcome.seconds.build = watch.lap();
  search_index(octree, problem, variant.mailboxing, options, outcome);
  outcome.seconds.search = watch.lap();
  return outcome;
}

std::unique_ptr<Prepared> prepare_octree(const Problem& problem, const OctreeParameters& parameters,
                                         const std::stop_token& stop) {
  const IndexVariant variant;
  return std::make_unique<PreparedIndex<Octree>>(problem, variant.mailboxing, parameters.depth, variant, stop);
}

void run_octree(const Problem& problem, const OctreeParameters& parameters, const RunOptions& options,
                Outcome& outcome) {
  outcome = search_octree(problem, parameters, {}, options);
}

}  // namespace detp::sim
