#include "structural_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/predicates.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/index/disc_index.hpp"

/// Expected counts of an index of discs, computed from the built index without rays.
///
/// Counts of an octree, a grid or a BSP tree on isotropic lines through S₀:
///
///     nodes or steps = n_R Σ P(node)        disc_tests = n_R Σ_leaves P(leaf) references(leaf)
///     P(node) = F(node)/(4π r₀²) × share of the lines through the node that also cross S₀
///
///   where  F   surface area of the node, or of the part of a grid's cell inside the grid's box
///
/// The share is 1 for a node inside S₀. For a node that extends outside S₀, the share is integrated over lines of a
/// fixed pool, moved so that they go through the node; larger nodes use more lines. References and placements are
/// exact.
///
/// Source     eq (3), summed over the structure: the surface-area heuristic.
/// Valid      lines of the measure μ_ℓ through S₀; discs of any radii.
/// Throws     std::invalid_argument for an octree traversal that may visit a node more than once for a ray, or skips
///            nodes (restart, neighbour links); as sim::run does for parameters out of range and for an index that
///            would not fit in memory.
namespace detp::validate {
namespace {

using std::numbers::pi;

constexpr std::size_t entry_pool_size = 4096;
constexpr std::uint64_t entry_pool_seed = 1;

double area_of(const glm::dvec3& size) { return 2 * (size.x * size.y + size.y * size.z + size.z * size.x); }

/// A line that enters any box. The numbers (0 … 1) select the face of the box and the place on the face. `inwards` is
/// the inward direction, cosine-distributed, for a face perpendicular to the third axis.
struct Entry {
  double face;
  double first;
  double second;
  glm::dvec3 inwards;
};

std::vector<Entry> make_entry_pool() {
  std::vector<Entry> pool;
  for (std::size_t i = 0; i < entry_pool_size; ++i) {
    const auto place = sim::uniform4(entry_pool_seed, sim::Stream::tests, i);
    const double angle = 2 * pi * sim::uniform4(entry_pool_seed, sim::Stream::tests, i, 1)[0];
    const double sine = std::sqrt(place[3]);
    pool.push_back(
        {place[0], place[1], place[2], {sine * std::cos(angle), sine * std::sin(angle), std::sqrt(1 - place[3])}});
  }
  return pool;
}

/// The line that enters this box as `entry` says. Places are uniform over the area of the box's surface and directions
/// are cosine-distributed, so the lines have the measure μ_ℓ of the lines that meet the box.
sim::Ray line_into(const sim::Box& box, const Entry& entry) {
  const glm::dvec3 size = box.size();
  double pick = entry.face * area_of(size);
  int axis = 0;
  for (; axis < 2; ++axis) {
    const double faces = 2 * size[(axis + 1) % 3] * size[(axis + 2) % 3];
    if (pick < faces) break;
    pick -= faces;
  }
  const int second = (axis + 1) % 3;
  const int third = (axis + 2) % 3;
  const bool low = pick < size[second] * size[third];
  sim::Ray line{.origin = box.low};
  line.origin[axis] = low ? box.low[axis] : box.high[axis];
  line.origin[second] += entry.first * size[second];
  line.origin[third] += entry.second * size[third];
  line.direction[axis] = low ? entry.inwards.z : -entry.inwards.z;
  line.direction[second] = entry.inwards.x;
  line.direction[third] = entry.inwards.y;
  return line;
}

/// P(node).
class NodeCrossing {
 public:
  explicit NodeCrossing(const sim::Sphere& enclosing) : enclosing_(enclosing) {}

  double operator()(const sim::Box& box) {
    const double share = area_of(box.size()) / (4 * pi * enclosing_.radius * enclosing_.radius);
    const glm::dvec3 reach = glm::max(glm::abs(box.low - enclosing_.centre), glm::abs(box.high - enclosing_.centre));
    lines_ = 0;
    if (glm::dot(reach, reach) <= enclosing_.radius * enclosing_.radius) return share;
    lines_ = static_cast<std::size_t>(std::clamp(16 * entry_pool_size * share, 32.0, 1.0 * entry_pool_size));
    std::size_t crossing = 0;
    for (std::size_t i = 0; i < lines_; ++i)
      crossing += sim::hits(line_into(box, pool_[next_++ % entry_pool_size]), enclosing_) ? 1 : 0;
    return share * static_cast<double>(crossing) / static_cast<double>(lines_);
  }

  /// Number of lines used by the last call; 0 if its node lies in S₀.
  [[nodiscard]] std::size_t lines() const { return lines_; }

 private:
  sim::Sphere enclosing_;
  std::vector<Entry> pool_ = make_entry_pool();
  std::size_t next_ = 0;
  std::size_t lines_ = 0;
};

/// Expected counts of an index. `inspect(visit)` calls `visit` for each node of the index.
template <class Inspect>
Counts<double> index_counts(const sim::Problem& problem, double rays, double Counts<double>::*visited,
                            const std::stop_token& stop, const Inspect& inspect) {
  sim::StopCheck check(stop, "counting cells");
  NodeCrossing crossing(problem.enclosing());
  double visits = 0;
  double tests = 0;
  const sim::IndexSize size = inspect([&](const sim::IndexNode& node) {
    const double chance = crossing(node.box);
    check.after(crossing.lines() + 1);
    visits += chance;
    tests += chance * static_cast<double>(node.references);
  });
  Counts<double> counts{.disc_tests = rays * tests,
                        .references = static_cast<double>(size.references),
                        .placements = static_cast<double>(size.placements)};
  counts.*visited = rays * visits;
  return counts;
}

}  // namespace

Counts<double> counts_of(const sim::Problem& problem, const Lines& lines, const OctreeParameters& parameters,
                         const std::stop_token& stop) {
  if (parameters.traversal != Traversal::top_down && parameters.traversal != Traversal::front_to_back)
    throw std::invalid_argument(fmt::format("structural counts know an octree top-down or front-to-back only (got {})",
                                            name(parameters.traversal)));
  return index_counts(problem, lines.rays, &Counts<double>::nodes, stop,
                      [&](const auto& visit) { return inspect_octree(problem, parameters, {}, visit, stop); });
}

Counts<double> counts_of(const sim::Problem& problem, const Lines& lines, const GridParameters& parameters,
                         const std::stop_token& stop) {
  return index_counts(problem, lines.rays, &Counts<double>::steps, stop,
                      [&](const auto& visit) { return inspect_grid(problem, parameters, {}, visit, stop); });
}

Counts<double> counts_of(const sim::Problem& problem, const Lines& lines, const BspParameters& parameters,
                         const std::stop_token& stop) {
  return index_counts(problem, lines.rays, &Counts<double>::nodes, stop,
                      [&](const auto& visit) { return inspect_bsp(problem, parameters, visit, stop); });
}

}  // namespace detp::validate
