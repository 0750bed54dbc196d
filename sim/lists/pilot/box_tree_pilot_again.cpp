#include <algorithm>
#include <cmath>

#include "box_tree_pilot.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/lists/simd/list_search.hpp"
#include "detp/sim/lists/simd/ray_blocks.hpp"

/// A second, larger sample of rays for nodes that few rays of the first sample reach.
namespace detp::sim::stream {
namespace {

constexpr double few = 24;             ///< sampled rays; with more, their spread shows the error
constexpr double largest_error = 0.2;  ///< of the work of all sampled rays
constexpr double wanted_error = 0.1;   ///< with a second sample
constexpr double least_error = 0.02;   ///< of a node that gets a second sample
constexpr std::size_t most_regions = 16;
constexpr double most_rays = 64;  ///< in the second sample for each ray of the first one
constexpr std::size_t rays_in_turn = 2048;

}  // namespace

/// Finds the nodes of the top whose error is large. With c sampled rays in a node's list, the error is that of c + 2 rays,
/// so that a node that no sampled ray crosses has an error, too (A. Agresti and B. A. Coull, 1998: for two standard errors, add
/// half the square of two to the count).
///
///     e = √(c + 2) u         F = Σ e² / (0.1 W)², from 4 to 64, if Σ e² > (0.2 W)²
///
///   where  u   expected work of a ray that crosses the node (set_expected_work)
///          W   expected work of all sampled rays: Σ c u over the subtrees, and some for each ray
///          F   rays in the second sample for each ray in the first: error² is proportional to 1/F
///
/// Source     our derivation.
BoxTreePilot::SecondSample BoxTreePilot::plan_second_sample() const {
  constexpr double of_each_ray = 20;
  double work = of_each_ray * sampled_;
  for (const Subtree& subtree : subtrees_) work += known_[subtree.root].rays * work_of_a_ray(subtree.root);
  struct Sparse {
    std::uint32_t node;
    double error;
  };
  std::vector<Sparse> sparse;
  const auto consider = [&](std::uint32_t node) {
    const double rays = known_[node].rays;
    const double error = std::sqrt(rays + 2) * work_of_a_ray(node);
    if (node != 0 && rays < few && error > least_error * work) sparse.push_back({node, error});
  };
  for (std::uint32_t node = 0; node < coarse_; ++node)
    if (nodes_[node].count > most_in_a_subtree) consider(node);
  for (const Subtree& subtree : subtrees_) consider(subtree.root);
  std::stable_sort(sparse.begin(), sparse.end(), [](const Sparse& a, const Sparse& b) { return a.error > b.error; });
  SecondSample second;
  double squares = 0;
  for (const Sparse& one : sparse) {
    const BinaryNode& node = nodes_[one.node];
    const bool nested = std::any_of(second.regions.begin(), second.regions.end(), [&](const Region& region) {
      const BinaryNode& other = nodes_[region.node];
      return node.first < other.first + other.count && other.first < node.first + node.count;
    });
    if (nested || second.regions.size() == most_regions) continue;
    second.regions.push_back({.node = one.node});
    squares += one.error * one.error;
  }
  constexpr double least_rays = 4;
  second.precision = std::clamp(squares / std::pow(wanted_error * work, 2), least_rays, most_rays);
  if (squares <= std::pow(largest_error * work, 2)) second.regions.clear();
  return second;
}

/// Culls the second sample against the regions' boxes, a part at a time, and loads the rays that cross each.
void BoxTreePilot::draw_second_sample(const Sample& first, std::span<const Ray> others, SecondSample& second,
                                      Worker& worker) const {
  if (second.regions.empty()) return;
  constexpr double worth_it = 2;
  const auto rays = std::min(static_cast<double>(others.size()), std::floor(second.precision * sampled_));
  second.precision = rays / sampled_;
  if (second.precision < worth_it) return second.regions.clear();
  const auto drawn = stratified_sample(others.size(), static_cast<std::size_t>(rays), 2, Stream::pilot);
  Problem problem = first.block.problem;
  std::vector<Ray> part;
  for (std::size_t from = 0; from < drawn.size(); from += rays_in_turn) {
    const std::size_t count = std::min(rays_in_turn, drawn.size() - from);
    part.resize(count);
    for (std::size_t i = 0; i < count; ++i) part[i] = others[drawn[from + i]];
    set_rays(problem, part);
    const ArenaScope scope(worker.lists);
    RayLists lists;
    for (RayList& list : lists) list = worker.lists.allocate(count, true);
    const bool segments = load_rays(problem.rays(), first.block.frame, lists).segments;
    BlockSearch block = first.block;
    block.segments = segments;
    for (Region& region : second.regions) {
      const ArenaScope of_region(worker.lists);
      const RayLists inside = cull_node(block, as_leaf(nodes_[region.node]), lists, worker);
      for (const RayList& list : inside)
        for (std::size_t i = 0; i < list.size; ++i) {
          const std::size_t ray = list.id[i] & ~falling;
          region.rays.push_back(problem.rays()[ray]);
          region.group.push_back(static_cast<std::uint32_t>((from + ray) * groups / drawn.size()));
        }
    }
    worker.check.now();
  }
  for (Region& region : second.regions) {
    region.problem.emplace(first.block.problem);
    if (region.rays.empty()) continue;
    set_rays(*region.problem, region.rays);
    for (RayList& list : region.lists) list = worker.lists.allocate(region.rays.size(), true);
    region.segments = load_rays(region.problem->rays(), first.block.frame, region.lists).segments;
  }
}

}  // namespace detp::sim::stream
