#include <algorithm>
#include <utility>

#include "box_tree_pilot.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/lists/simd/list_search.hpp"

/// The drawn subtrees: which they are, and what the rays do there.
namespace detp::sim::stream {
namespace {

constexpr std::uint64_t seed = 1;

}  // namespace

/// Draws subtrees systematically, with probabilities proportional to their work; those with much work for certain.
void BoxTreePilot::draw_subtrees(std::size_t most) {
  if (most >= subtrees_.size()) {
    for (Subtree& subtree : subtrees_) subtree.weight = 1;
    return;
  }
  std::size_t left = most;
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

void BoxTreePilot::refine(const Sample& sample, Subtree& subtree, Worker& worker) {
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
  RayLists inside;
  if (size(sample.lists) > 0) inside = cull_node(sample.block, as_leaf(nodes_[subtree.first]), sample.lists, worker);
  if (subtree.root != 0)
    known_[subtree.first].rays = static_cast<float>(static_cast<double>(size(inside)) / sample.precision);
  const Counts<std::uint64_t> before = worker.counts;
  cull_refined(sample, subtree.first, inside, subtree, worker);
  subtree.doubtful = static_cast<double>(worker.counts.doubtful - before.doubtful) / sample.precision;
  const auto rays = static_cast<double>(size(inside));
  const auto finish = [&](SumOverRays& of_rays) {
    if (rays > 0) of_rays.squares = std::max(0.0, of_rays.squares - of_rays.sum * of_rays.sum / rays);
    of_rays.sum /= sample.precision;
    of_rays.squares /= sample.precision * sample.precision;
  };
  const auto add = [](SumOverRays& sum, double of_ray) {
    sum.sum += of_ray;
    sum.squares += of_ray * of_ray;
  };
  const SumOverRays of_leaves = std::exchange(subtree.hits, {});
  for (const RayList& list : inside)
    for (std::size_t i = 0; i < list.size; ++i) {
      const OfRay ray = std::exchange(of_ray_[list.id[i] & ~falling], {});
      add(subtree.disc_tests, ray.disc_tests);
      add(subtree.hits, ray.hits);
    }
  finish(subtree.disc_tests);
  finish(subtree.hits);
  subtree.hits.sum = of_leaves.sum / sample.precision;  // without rounding
  subtree.hits.squares += of_leaves.squares / (sample.precision * sample.precision);
}

void BoxTreePilot::cull_refined(const Sample& sample, std::uint32_t node, const RayLists& lists, Subtree& subtree,
                                Worker& worker) {
  const BinaryNode& here = nodes_[node];
  if (here.leaf()) {
    if (size(lists) == 0) return;
    std::fill_n(sample.block.hits + here.first, here.count, ClassCounts{});
    search_below(sample.block, as_leaf(here), lists, worker);
    double hits = 0;
    for (std::uint32_t place = here.first; place < here.first + here.count; ++place)
      for (const std::uint32_t by_class : sample.block.hits[place]) hits += by_class;
    const auto hits_of_each = static_cast<float>(hits / static_cast<double>(size(lists)));
    for (const RayList& list : lists)
      for (std::size_t i = 0; i < list.size; ++i) {
        OfRay& ray = of_ray_[list.id[i] & ~falling];
        ray.disc_tests += static_cast<float>(here.count);
        ray.hits += hits_of_each;
      }
    subtree.hits.sum += hits;
    // A leaf's hits are spread evenly over its rays. At worst, a few of these hit all discs, and the others none.
    subtree.hits.squares += hits * (here.count - hits / static_cast<double>(size(lists)));
    return;
  }
  for (const std::uint32_t child : {node + 1, here.right}) {
    const ArenaScope scope(worker.lists);
    cull_refined(sample, child, cull_child(sample, child, lists, subtree.weight, worker), subtree, worker);
  }
}

}  // namespace detp::sim::stream
