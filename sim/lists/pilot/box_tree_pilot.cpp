#include "box_tree_pilot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <deque>
#include <memory>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/lists/simd/list_search.hpp"
#include "detp/sim/lists/simd/ray_blocks.hpp"

namespace detp::sim::stream {
namespace {

constexpr std::uint32_t coarse_leaf = 256;  ///< the nodes of subtrees that are not drawn are built down to this size

using FourFloats = float __attribute__((vector_size(16)));

/// A box as vectors, the fourth number of which is not used.
struct VectorBox {
  FourFloats low{2, 2, 2, 2};
  FourFloats high{-2, -2, -2, -2};

  void include(const FloatDisc& disc) {
    FourFloats centre;
    std::memcpy(&centre, &disc, sizeof(centre));
    const FourFloats from = centre - disc.radius;
    const FourFloats to = centre + disc.radius;
    low = from < low ? from : low;
    high = to > high ? to : high;
  }
};

/// A box that contains the discs, whatever their normals are.
FloatBox box_around_balls(std::span<const FloatDisc> discs) {
  VectorBox even;
  VectorBox odd;  // two boxes, because each has to wait for its last disc
  for (std::size_t i = 0; i + 1 < discs.size(); i += 2) {
    even.include(discs[i]);
    odd.include(discs[i + 1]);
  }
  if (!discs.empty()) even.include(discs.back());
  FloatBox box;
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::min(even.low[axis], odd.low[axis]);
    box.high[axis] = std::max(even.high[axis], odd.high[axis]);
  }
  return box;
}

std::vector<std::uint32_t> groups_of(std::size_t rays, std::size_t groups) {
  std::vector<std::uint32_t> group(rays);
  for (std::size_t i = 0; i < rays; ++i) group[i] = static_cast<std::uint32_t>(i * groups / rays);
  return group;
}

}  // namespace

TreeNode as_leaf(const BinaryNode& node) {
  TreeNode leaf{.centre = {}, .half = {}, .first = node.first, .count = node.count & 0x7fff'ffff, .leaf = 1};
  for (int axis = 0; axis < 3; ++axis) {
    leaf.centre[axis] = 0.5F * (node.box.low[axis] + node.box.high[axis]);
    leaf.half[axis] = 0.5F * (node.box.high[axis] - node.box.low[axis]);
  }
  return leaf;
}

BoxTreePilot::BoxTreePilot(const Problem& problem, const Frame& frame, const SortedDiscs& discs, const PilotRays& rays,
                           std::size_t subtrees, const std::stop_token& stop)
    : discs_(discs),
      rays_(rays.all),
      sampled_(static_cast<double>(rays.sample.size())),
      independent_(rays.independent),
      blocks_(ray_blocks(rays_, static_cast<double>(discs.tree.discs.size()), Engine::simd)),
      given_hits_(rays.hits) {
  const std::span<const Ray> sample = rays.sample;
  Problem of_sample = problem;
  set_rays(of_sample, sample);
  Worker worker(std::pmr::new_delete_resource(), stop);
  RayLists lists;
  for (RayList& list : lists) list = worker.lists.allocate(sample.size(), true);
  const RayTraits traits = load_rays(sample, frame, lists);
  // Only the pages of drawn subtrees are touched.
  const auto hits = std::make_unique_for_overwrite<ClassCounts[]>(discs.tree.discs.size());
  const auto totals =
      problem.front_facing() ? std::make_unique_for_overwrite<DiscTotals[]>(discs.tree.discs.size()) : nullptr;
  std::deque<std::vector<double>> powers;  // front-facing hits are summed, not counted; the sums are not used
  std::deque<Sample> samples;
  const auto add_sample = [&](const Problem& of_rays, const RayLists& loaded, bool segments) -> Sample& {
    powers.emplace_back(totals ? of_rays.rays().size() : 0, 1.0);
    return samples.emplace_back(Sample{.block = {.problem = of_rays,
                                                 .frame = frame,
                                                 .tree = discs.tree,
                                                 .first_ray = 0,
                                                 .segments = segments,
                                                 .pairs = false,
                                                 .vectors = false,
                                                 .hits = hits.get(),
                                                 .totals = totals.get(),
                                                 .powers = powers.back().data()},
                                       .lists = loaded});
  };
  add_sample(of_sample, lists, traits.segments).group = groups_of(sample.size(), groups);
  const std::size_t nodes = 4 * discs.tree.discs.size() / coarse_leaf + subtrees * most_in_a_subtree;
  nodes_.reserve(nodes);
  area_.reserve(nodes);
  build_coarse(0, static_cast<std::uint32_t>(discs.tree.discs.size()));
  coarse_ = static_cast<std::uint32_t>(nodes_.size());
  for (const BinaryNode& node : nodes_) area_.push_back(node.box.area());
  known_.resize(nodes_.size());
  share_.resize(nodes_.size());
  set_radius();
  set_expected_work();
  find_subtrees(0);
  segments_ = traits.segments;
  of_ray_.resize(sample.size());
  cull_top(samples.front(), 0, worker);
  StopCheck(stop, "culling the pilot's rays").now();
  SecondSample second = plan_second_sample();
  draw_second_sample(samples.front(), rays.others, second, worker);
  for (const Region& region : second.regions) {
    Sample& again = add_sample(*region.problem, region.lists, region.segments);
    again.precision = second.precision;
    again.group = region.group;
    again.root = region.node;
    of_ray_.resize(std::max(of_ray_.size(), region.group.size()));
    cull_top(again, static_cast<std::uint32_t>(samples.size() - 1), worker);
    StopCheck(stop, "culling the pilot's rays").now();
  }
  draw_subtrees(subtrees);
  for (Subtree& subtree : subtrees_)
    if (subtree.weight > 0) {
      refine(samples[subtree.sample], subtree, worker);
      StopCheck(stop, "culling the pilot's rays").now();
    }
  set_blocks();
  set_hits();
  set_ray_errors();
}

/// Builds the top of the tree, and the nodes below it down to coarse_leaf discs. Returns the node's number.
std::uint32_t BoxTreePilot::build_coarse(std::uint32_t first, std::uint32_t count) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({.box = nothing, .first = first, .count = count, .right = 0, .cost = 0});
  if (count <= coarse_leaf) {
    nodes_[number].box = box_around_balls(std::span(discs_.tree.discs).subspan(first, count));
    return number;
  }
  const std::uint32_t middle = boundary(*discs_.places, first, count);
  build_coarse(first, middle - first);
  const std::uint32_t right = build_coarse(middle, first + count - middle);
  nodes_[number].right = right;
  nodes_[number].box = joined(nodes_[number + 1].box, nodes_[right].box);
  return number;
}

/// A ray that crosses a coarse leaf crosses the boxes around some of its discs, and tests the discs of a few small leaves.
void BoxTreePilot::set_expected_work() {
  const double box_of_disc = 12 * static_cast<double>(radius_) * radius_;  // half its surface
  constexpr double leaves = 2.5;
  work_.resize(coarse_);
  for (std::uint32_t node = coarse_; node-- > 0;) {
    const BinaryNode& here = nodes_[node];
    const double area = area_[node];
    const double count = here.count;
    work_[node] = here.leaf() ? std::min(area * count, area * leaves * std::sqrt(count) + count * box_of_disc)
                              : area + work_[node + 1] + work_[here.right];
  }
}

void BoxTreePilot::find_subtrees(std::uint32_t node) {
  if (nodes_[node].count <= most_in_a_subtree) {
    subtrees_.push_back({.root = node});
  } else {
    find_subtrees(node + 1);
    find_subtrees(nodes_[node].right);
  }
}

/// Culls the sample, or a part of the second sample, down the top below its root.
void BoxTreePilot::cull_top(const Sample& sample, std::uint32_t number, Worker& worker) {
  const auto rays = static_cast<double>(size(sample.lists)) / sample.precision;
  Known& known = known_[sample.root];
  known.rays = static_cast<float>(rays);
  known.precision = static_cast<float>(sample.precision);
  known.weight = 1;
  if (sample.root == 0) {
    known.blocks = static_cast<float>(blocks_.count());
    share_[0] = rays / sampled_;
  }
  const auto first = std::lower_bound(subtrees_.begin(), subtrees_.end(), sample.root,
                                      [](const Subtree& one, std::uint32_t root) { return one.root < root; });
  auto subtree = static_cast<std::size_t>(first - subtrees_.begin());
  cull_top_below(sample, number, sample.root, sample.lists, subtree, worker);
}

/// Returns the child's lists, which stay in the worker's arena until the caller's scope ends, and notes their size.
RayLists BoxTreePilot::cull_child(const Sample& sample, std::uint32_t child, const RayLists& lists, double weight,
                                  Worker& worker) {
  RayLists inside;
  if (size(lists) > 0) inside = cull_node(sample.block, as_leaf(nodes_[child]), lists, worker);
  known_[child].rays = static_cast<float>(static_cast<double>(size(inside)) / sample.precision);
  known_[child].precision = static_cast<float>(sample.precision);
  known_[child].weight = static_cast<float>(weight);
  return inside;
}

void BoxTreePilot::cull_top_below(const Sample& sample, std::uint32_t number, std::uint32_t node, const RayLists& lists,
                                  std::size_t& subtree, Worker& worker) {
  const BinaryNode& here = nodes_[node];
  if (here.count <= most_in_a_subtree) {
    Subtree& found = subtrees_[subtree++];
    found.sample = number;
    found.work = (1 / sample.precision + known_[node].rays) * work_of_a_ray(node);
    found.rays = {};
    for (const RayList& list : lists)
      for (std::size_t i = 0; i < list.size; ++i) ++found.rays[sample.group[list.id[i] & ~falling]];
    return;
  }
  for (const std::uint32_t child : {node + 1, here.right}) {
    const ArenaScope scope(worker.lists);
    cull_top_below(sample, number, child, cull_child(sample, child, lists, 1, worker), subtree, worker);
  }
}

/// Expected work below a coarse node for a ray that crosses its box.
double BoxTreePilot::work_of_a_ray(std::uint32_t node) const {
  const double area = area_[node];  // 0 if the discs are in one point and too small for floats
  return area > 0 ? work_[node] / area : nodes_[node].count;
}

void BoxTreePilot::set_radius() {
  constexpr std::size_t most = 1024;
  const std::span<const FloatDisc> discs(discs_.tree.discs);
  const std::size_t step = (discs.size() - 1) / most + 1;
  float squares = 0;
  float count = 0;
  for (std::size_t place = 0; place < discs.size(); place += step, ++count)
    squares += discs[place].radius * discs[place].radius;
  radius_ = std::sqrt(squares / count);
}

}  // namespace detp::sim::stream
