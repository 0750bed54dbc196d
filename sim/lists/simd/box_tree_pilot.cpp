#include "box_tree_pilot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/random.hpp"
#include "load_rays.hpp"
#include "tree_search.hpp"

namespace detp::sim::stream {
namespace {

constexpr std::uint32_t coarse_leaf = 256;  ///< the nodes of subtrees that are not drawn are built down to this size
constexpr std::uint64_t seed = 1;

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
FloatBox box_around(std::span<const FloatDisc> discs) {
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

TreeNode as_tree_node(const BinaryNode& node) {
  TreeNode box{.centre = {}, .half = {}, .first = node.first, .count = node.count & 0x7fff'ffff, .leaf = 1};
  for (int axis = 0; axis < 3; ++axis) {
    box.centre[axis] = 0.5F * (node.box.low[axis] + node.box.high[axis]);
    box.half[axis] = 0.5F * (node.box.high[axis] - node.box.low[axis]);
  }
  return box;
}

}  // namespace

BoxTreePilot::BoxTreePilot(const Problem& problem, const Frame& frame, const SortedDiscs& discs, const PilotRays& rays,
                           std::size_t subtrees, const std::stop_token& stop)
    : discs_(discs),
      rays_(rays.all),
      sampled_(static_cast<double>(rays.sample.size())),
      unseen_(rays.independent ? 1 : std::max(0.0, 1 - sampled_ / rays_)),
      blocks_(ray_blocks(rays_, static_cast<double>(discs.tree.discs.size()), Engine::simd)),
      work_(rays.sample.size()) {
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
  const std::vector<double> powers(totals ? sample.size() : 0, 1.0);
  const BlockSearch block{.problem = of_sample,
                          .frame = frame,
                          .tree = discs.tree,
                          .first_ray = 0,
                          .segments = traits.segments,
                          .pairs = false,
                          .vectors = false,
                          .hits = hits.get(),
                          .totals = totals.get(),
                          .powers = powers.data()};
  const std::size_t nodes = 4 * discs.tree.discs.size() / coarse_leaf + subtrees * most_in_a_subtree;
  nodes_.reserve(nodes);
  area_.reserve(nodes);
  build_coarse(0, static_cast<std::uint32_t>(discs.tree.discs.size()));
  coarse_ = static_cast<std::uint32_t>(nodes_.size());
  for (const BinaryNode& node : nodes_) area_.push_back(node.box.area());
  known_.resize(nodes_.size());
  share_.resize(nodes_.size());
  segments_ = traits.segments;
  cull_top(block, lists, worker);
  StopCheck(stop, "culling the pilot's rays").now();
  draw_subtrees(subtrees);
  for (Subtree& subtree : subtrees_)
    if (subtree.weight > 0) {
      refine(block, lists, subtree, worker);
      StopCheck(stop, "culling the pilot's rays").now();
    }
  hits_ = rays.hits.value_or(hits_ * rays_ / sampled_);
  set_blocks();
  set_relative_error();
  set_radius();
}

/// Builds the top of the tree, and the nodes below it down to coarse_leaf discs. Returns the node's number.
std::uint32_t BoxTreePilot::build_coarse(std::uint32_t first, std::uint32_t count) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({.box = nothing, .first = first, .count = count, .right = 0, .cost = 0});
  if (count <= coarse_leaf) {
    nodes_[number].box = box_around(std::span(discs_.tree.discs).subspan(first, count));
    return number;
  }
  const std::uint32_t middle = boundary(*discs_.places, first, count);
  build_coarse(first, middle - first);
  const std::uint32_t right = build_coarse(middle, first + count - middle);
  nodes_[number].right = right;
  nodes_[number].box = nodes_[number + 1].box;
  nodes_[number].box.include(nodes_[right].box);
  return number;
}

void BoxTreePilot::cull_top(const BlockSearch& block, const RayLists& rays, Worker& worker) {
  known_[0].rays = static_cast<float>(size(rays));
  known_[0].weight = 1;
  known_[0].blocks = static_cast<float>(blocks_.count());
  share_[0] = static_cast<double>(size(rays)) / sampled_;
  cull_top_below(block, 0, rays, worker);
}

/// Returns the child's lists, which stay in the worker's arena until the caller's scope ends, and notes their size.
RayLists BoxTreePilot::cull_child(const BlockSearch& block, std::uint32_t child, const RayLists& lists, double weight,
                                  Worker& worker) {
  RayLists inside = worker.lists.allocate_like(lists, block.segments);
  if (size(lists) > 0) cull_node(block, as_tree_node(nodes_[child]), lists, inside, worker);
  known_[child].rays = static_cast<float>(size(inside));
  known_[child].weight = static_cast<float>(weight);
  return inside;
}

void BoxTreePilot::cull_top_below(const BlockSearch& block, std::uint32_t node, const RayLists& lists, Worker& worker) {
  const BinaryNode& here = nodes_[node];
  if (here.count <= most_in_a_subtree) {
    const auto discs = static_cast<float>(std::sqrt(here.count));
    const double area = here.box.area();  // 0 if the discs are in one point and too small for floats
    const double of_a_ray = area > 0 ? expected_work(node) / area : discs;
    subtrees_.push_back({.root = node, .work = (1 + known_[node].rays) * of_a_ray});
    for (const RayList& list : lists)
      for (std::size_t i = 0; i < list.size; ++i) work_[list.id[i] & ~falling] += discs;
    return;
  }
  for (const std::uint32_t child : {node + 1, here.right}) {
    const ArenaScope scope(worker.lists);
    cull_top_below(block, child, cull_child(block, child, lists, 1, worker), worker);
  }
}

/// Expected work below a coarse node for a ray that crosses it, times the area of its box.
double BoxTreePilot::expected_work(std::uint32_t node) const {
  const BinaryNode& here = nodes_[node];
  if (here.leaf()) return here.box.area() * std::sqrt(here.count);
  return here.box.area() + expected_work(node + 1) + expected_work(here.right);
}

/// Draws subtrees systematically, with probabilities proportional to their work; those with much work for certain.
void BoxTreePilot::draw_subtrees(std::size_t most) {
  std::size_t left = std::min(most, subtrees_.size());
  double total = 0;
  for (const Subtree& subtree : subtrees_) total += subtree.work;
  for (bool more = true; more && left > 0;) {
    more = false;
    for (Subtree& subtree : subtrees_)
      if (subtree.weight == 0 && left > 0 && subtree.work * static_cast<double>(left) >= total) {
        subtree.weight = 1;
        total -= subtree.work;
        --left;
        more = true;
      }
  }
  if (left == 0) return;
  const double step = total / static_cast<double>(left);
  double next = step * uniform4(seed, Stream::pilot, 0, 1)[0];
  double sum = 0;
  for (Subtree& subtree : subtrees_) {
    if (subtree.weight == 1) continue;
    sum += subtree.work;
    if (sum <= next) continue;
    subtree.weight = step / subtree.work;
    next += step;
  }
}

void BoxTreePilot::refine(const BlockSearch& block, const RayLists& rays, Subtree& subtree, Worker& worker) {
  const BinaryNode root = nodes_[subtree.root];
  subtree.first = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2 * root.count);
  subtree.last = split_run(discs_, finest_leaf, root.first, root.count, nodes_.data(), subtree.first);
  nodes_.resize(subtree.last);
  for (std::uint32_t i = subtree.first; i < subtree.last; ++i) area_.push_back(nodes_[i].box.area());
  known_.resize(subtree.last);
  share_.resize(subtree.last);
  known_[subtree.root].refined = subtree.first;
  known_[subtree.first] = known_[subtree.root];
  known_[subtree.first].refined = 0;
  const ArenaScope scope(worker.lists);
  RayLists inside = worker.lists.allocate_like(rays, block.segments);
  cull_node(block, as_tree_node(nodes_[subtree.first]), rays, inside, worker);
  if (subtree.root != 0) known_[subtree.first].rays = static_cast<float>(size(inside));
  const Counts<std::uint64_t> before = worker.counts;
  cull_refined(block, subtree.first, inside, subtree.weight, worker);
  doubtful_ += subtree.weight * static_cast<double>(worker.counts.doubtful - before.doubtful);
  subtree.tests = static_cast<double>(tests(worker.counts) - tests(before));
}

void BoxTreePilot::cull_refined(const BlockSearch& block, std::uint32_t node, const RayLists& lists, double weight,
                                Worker& worker) {
  const BinaryNode& here = nodes_[node];
  if (here.leaf()) {
    if (size(lists) == 0) return;
    std::fill_n(block.hits + here.first, here.count, ClassCounts{});
    search_below(block, as_tree_node(here), lists, worker);
    for (std::uint32_t place = here.first; place < here.first + here.count; ++place)
      for (const std::uint32_t hits : block.hits[place]) hits_ += weight * hits;
    return;
  }
  for (const std::uint32_t child : {node + 1, here.right}) {
    const ArenaScope scope(worker.lists);
    cull_refined(block, child, cull_child(block, child, lists, weight, worker), weight, worker);
  }
}

/// From the spread of the drawn subtrees' tests, and from that of the rays' work.
void BoxTreePilot::set_relative_error() {
  double all = 0;  // tests in subtrees
  double drawn = 0;
  double sum = 0;
  double squares = 0;
  for (const Subtree& subtree : subtrees_) {
    const double stands_for = subtree.weight * subtree.tests;
    all += stands_for;
    if (subtree.weight <= 1) continue;
    drawn += 1;
    sum += stands_for;
    squares += stands_for * stands_for;
  }
  if (all == 0) return;
  const double of_subtrees = drawn > 1 ? std::max(0.0, squares - sum * sum / drawn) * drawn / (drawn - 1) : 0;
  double work = 0;
  double work_squares = 0;
  for (const double of_ray : work_) {
    work += of_ray;
    work_squares += of_ray * of_ray;
  }
  const double spread = std::max(0.0, sampled_ * work_squares / (work * work) - 1);
  relative_error_ = std::sqrt(of_subtrees / (all * all) + spread / sampled_ * unseen_);
}

void BoxTreePilot::set_radius() {
  constexpr std::size_t most = 1024;
  const std::vector<FloatDisc>& discs = discs_.tree.discs;
  const std::size_t step = (discs.size() - 1) / most + 1;
  float squares = 0;
  float count = 0;
  for (std::size_t place = 0; place < discs.size(); place += step, ++count)
    squares += discs[place].radius * discs[place].radius;
  radius_ = std::sqrt(squares / count);
}

}  // namespace detp::sim::stream
