#include <array>

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
  Octree(const Problem& problem, int depth, std::stop_token stop)
      : problem_(problem), depth_(depth), stop_(std::move(stop)), box_(index_box(problem.discs)) {
    const glm::dvec3 size = box_.size();
    box_.high = box_.low + glm::dvec3{std::max({size.x, size.y, size.z})};
    std::vector<std::uint32_t> all(problem.discs.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    nodes_.emplace_back();
    build(0, box_, 0, all);
  }

  [[nodiscard]] std::size_t references() const { return references_.size(); }
  [[nodiscard]] std::size_t placements() const { return placements_; }

  template <bool counting>
  void trace(std::uint32_t ray, IndexedSearch<counting>& search) const {
    const ClippedRay clipped(problem_.rays[ray]);
    if (!clipped.inside(grown(box_)).empty()) enter(0, box_, 0, ray, clipped, search);
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
        if (reached && overlaps(problem_.discs[i], octant_of(box, octant), problem_.slack)) parts[octant].push_back(i);
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

  template <bool counting>
  void enter(std::uint32_t number, const Box& box, int level, std::uint32_t ray, const ClippedRay& clipped,
             IndexedSearch<counting>& search) const {
    search.visit(&Counts<std::uint64_t>::nodes);
    const Node& node = nodes_[number];
    if (level == depth_) {
      search.test(ray, std::span(references_).subspan(node.first, node.count));
      return;
    }
    std::uint32_t child = node.first;
    for (unsigned octant = 0; octant < 8; ++octant) {
      if ((node.octants >> octant & 1) == 0) continue;
      const Box part = octant_of(box, octant);
      if (!clipped.inside(grown(part)).empty()) enter(child, part, level + 1, ray, clipped, search);
      ++child;
    }
  }

  const Problem& problem_;
  int depth_;
  std::stop_token stop_;
  Box box_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> references_;
  std::size_t placements_ = 0;
};

}  // namespace

void run_octree(const Problem& problem, const OctreeParameters& parameters, const RunOptions& options,
                Outcome& outcome) {
  Stopwatch watch;
  const Octree octree(problem, parameters.depth, options.stop);
  outcome.seconds.build = watch.lap();
  search_index(octree, problem, options, outcome);
  outcome.seconds.search = watch.lap();
}

}  // namespace detp::sim
