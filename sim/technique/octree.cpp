#include <array>
#include <bit>
#include <cmath>

#include "detp/sim/memory.hpp"
#include "disc_box.hpp"
#include "indexed_search.hpp"
#include "ray_box.hpp"
#include "techniques.hpp"

namespace detp::sim {
namespace {

/// A node's children lie together, in the order of their octants; a leaf's are references to discs.
struct Node {
  std::uint32_t first = 0;   ///< first child, or first reference
  std::uint32_t count = 0;   ///< references of a leaf
  std::uint8_t octants = 0;  ///< which children there are: bit (x + 2y + 4z)
};

Box octant_of(const Box& box, unsigned octant) {
  const glm::dvec3 middle = box.centre();
  Box part = box;
  for (int axis = 0; axis < 3; ++axis) (octant >> axis & 1 ? part.low : part.high)[axis] = middle[axis];
  return part;
}

class Octree {
 public:
  Octree(const Problem& problem, int depth, const IndexVariant& variant, std::stop_token stop)
      : problem_(problem), depth_(depth), variant_(variant), stop_(std::move(stop)), box_(index_box(problem.discs)) {
    const glm::dvec3 size = box_.size();
    box_.high = box_.low + glm::dvec3{std::max({size.x, size.y, size.z})};
    std::vector<std::uint32_t> all(problem.discs.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    nodes_.emplace_back();
    build(0, box_, 0, all);
    nodes_.shrink_to_fit();
    references_.shrink_to_fit();
  }

  [[nodiscard]] IndexSize size() const {
    return {.nodes = nodes_.size(),
            .references = references_.size(),
            .placements = placements_,
            .bytes = nodes_.size() * sizeof(nodes_[0]) + references_.size() * sizeof(references_[0])};
  }

  void show(const VisitNode& visit) const { show(0, box_, 0, visit); }

  template <class Search>
  void trace(std::uint32_t ray, Search& search) const {
    const ClippedRay clipped(problem_.rays[ray]);
    const Stretch stretch = clipped.inside(grown(box_));
    if (stretch.empty()) return;
    if (variant_.traversal == Traversal::restart)
      restart(ray, clipped, stretch, search);
    else
      enter(0, box_, 0, ray, clipped, search);
  }

 private:
  Box grown(const Box& box) const { return {box.low - problem_.slack, box.high + problem_.slack}; }

  void build(std::uint32_t node, const Box& box, int level, const std::vector<std::uint32_t>& discs) {
    if (stop_.stop_requested()) return;
    if (level == depth_) {
      nodes_[node].first = static_cast<std::uint32_t>(references_.size());
      nodes_[node].count = static_cast<std::uint32_t>(discs.size());
      references_.insert(references_.end(), discs.begin(), discs.end());
      require_room();
      return;
    }
    std::array<std::vector<std::uint32_t>, 8> parts = split(box, discs);
    nodes_[node].first = static_cast<std::uint32_t>(nodes_.size());
    for (unsigned octant = 0; octant < 8; ++octant)
      if (!parts[octant].empty()) {
        nodes_[node].octants |= static_cast<std::uint8_t>(1U << octant);
        nodes_.emplace_back();
        placements_ += parts[octant].size();
      }
    std::uint32_t child = nodes_[node].first;
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
        if (reached && (variant_.insertion == Insertion::bounding_box ||
                        overlaps(problem_.discs[i], octant_of(box, octant), problem_.slack)))
          parts[octant].push_back(i);
      }
    }
    return parts;
  }

  void require_room() const {
    require_memory("the octree", static_cast<double>(references_.size()) * sizeof(std::uint32_t) +
                                     static_cast<double>(nodes_.size()) * sizeof(Node));
    if (references_.size() >= UINT32_MAX || nodes_.size() >= UINT32_MAX)
      throw std::length_error("the octree would hold 2^32 or more references; a smaller depth is needed");
  }

  template <class VisitChild>
  void for_each_child(const Node& node, const Box& box, const VisitChild& visit) const {
    std::uint32_t child = node.first;
    for (unsigned octant = 0; octant < 8; ++octant)
      if (node.octants >> octant & 1) visit(child++, octant_of(box, octant));
  }

  void show(std::uint32_t number, const Box& box, int level, const VisitNode& visit) const {
    const Node& node = nodes_[number];
    visit({box, level, level == depth_, node.count});
    if (level < depth_)
      for_each_child(node, box, [&](std::uint32_t child, const Box& part) { show(child, part, level + 1, visit); });
  }

  template <class Search>
  void enter(std::uint32_t number, const Box& box, int level, std::uint32_t ray, const ClippedRay& clipped,
             Search& search) const {
    search.visit(&Counts<std::uint64_t>::nodes);
    const Node& node = nodes_[number];
    if (level == depth_) {
      search.test(ray, references_in(node));
      return;
    }
    for_each_child(node, box, [&](std::uint32_t child, const Box& part) {
      if (!clipped.inside(grown(part)).empty()) enter(child, part, level + 1, ray, clipped, search);
    });
  }

  std::span<const std::uint32_t> references_in(const Node& leaf) const {
    return std::span(references_).subspan(leaf.first, leaf.count);
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
    int below = depth_;
    search.visit(&Counts<std::uint64_t>::nodes);
    for (; below > 0; --below) {
      unsigned octant = 0;
      for (int axis = 0; axis < 3; ++axis) octant |= static_cast<unsigned>(place[axis] >> (below - 1) & 1) << axis;
      const unsigned octants = nodes_[number].octants;
      if ((octants >> octant & 1) == 0) break;
      number = nodes_[number].first + static_cast<std::uint32_t>(std::popcount(octants & ((1U << octant) - 1)));
      search.visit(&Counts<std::uint64_t>::nodes);
    }
    if (below == 0) search.test(ray, references_in(nodes_[number]));
    Cube cube{place, below == 0 ? 1 : std::int64_t{1} << (below - 1)};
    for (std::int64_t& low : cube.low) low -= low % cube.side;
    return cube;
  }

  Leaf leaf_at(const glm::dvec3& point, const Cube& within) const {
    const double side = box_.size().x / std::ldexp(1.0, depth_);
    Leaf leaf{};
    for (int axis = 0; axis < 3; ++axis) {
      const double place = std::floor((point[axis] - box_.low[axis]) / side);
      const auto low = static_cast<double>(within.low[axis]);
      leaf[axis] = static_cast<std::int64_t>(std::clamp(place, low, low + static_cast<double>(within.side - 1)));
    }
    return leaf;
  }

  /// Goes from leaf to leaf as the grid does from cell to cell, and descends anew to each.
  template <class Search>
  void restart(std::uint32_t ray, const ClippedRay& clipped, const Stretch& stretch, Search& search) const {
    const std::int64_t leaves = std::int64_t{1} << depth_;
    const double side = box_.size().x / static_cast<double>(leaves);
    const glm::dvec3& direction = problem_.rays[ray].direction;
    Leaf place = leaf_at(clipped.origin + stretch.from * direction, {{}, leaves});
    for (;;) {
      const Cube cube = descend(place, ray, search);
      int next = 0;
      double leave = unbounded;
      for (int axis = 0; axis < 3; ++axis) {
        if (std::isinf(clipped.inverse[axis])) continue;
        const auto plane = static_cast<double>(cube.low[axis] + (clipped.inverse[axis] > 0 ? cube.side : 0));
        const double t = (box_.low[axis] + plane * side - clipped.origin[axis]) * clipped.inverse[axis];
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
  int depth_;
  IndexVariant variant_;
  std::stop_token stop_;
  Box box_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> references_;
  std::size_t placements_ = 0;
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
  Outcome outcome;
  Stopwatch watch;
  const Octree octree(problem, parameters.depth, variant, options.stop);
  outcome.seconds.build = watch.lap();
  search_index(octree, problem, variant.mailboxing, options, outcome);
  outcome.seconds.search = watch.lap();
  return outcome;
}

void run_octree(const Problem& problem, const OctreeParameters& parameters, const RunOptions& options,
                Outcome& outcome) {
  outcome = search_octree(problem, parameters, {}, options);
}

}  // namespace detp::sim
