#include "box_tree.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "box_tree_crossing.hpp"
#include "box_tree_expected.hpp"
#include "box_tree_nodes.hpp"
#include "detp/model/vocabulary/ray_blocks.hpp"

namespace detp::model {
namespace box_tree {

/// Expected counts in the wide tree: per ray, except that `culls` and `visits` are for all rays.
struct TreeCounts {
  double tests = 0;
  double listed = 0;
  double discs = 0;
  double culls = 0;
  double visits = 0;
  double made = 0;
};

/// Joins the inner nodes of the binary tree to wide nodes.
class Widening {
 public:
  Widening(const std::vector<LevelNodes>& nodes, const std::vector<CellKind>& kinds)
      : nodes_(nodes), kinds_(kinds), links_(nodes.size()), moments_(nodes.size()) {
    for (std::size_t i = nodes.size(); i-- > 0;) {
      link(i);
      find_moments(i);
    }
  }

  /// Calls visit(kind of cell, number of wide nodes, children of each) for each kind that has wide nodes.
  template <class Visit>
  void for_each(int fan_out, const Visit& visit) {
    if (nodes_.empty()) return;
    opened_ = fan_out - 1;
    wide_.assign(nodes_.size(), 0);
    wide_[0] = nodes_[0].inner.count;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (wide_[i] > 1e-9) visit(i, wide_[i], 1 + open(i));
  }

 private:
  /// The model joins inner nodes at most this many levels below the top.
  static constexpr int deepest = 9;

  /// The halves of an inner node that are inner nodes themselves.
  struct Link {
    std::array<std::size_t, 2> child{};
    std::array<double, 2> inner{};  ///< probability that the half is an inner node
  };

  /// Mean and variance of the number of inner nodes at most `depth` levels below an inner node, including itself.
  struct Moments {
    std::array<double, deepest + 1> mean{};
    std::array<double, deepest + 1> variance{};
  };

  void link(std::size_t number) {
    const CellKind& kind = kinds_[number];
    const double here = nodes_[number].inner.count / kind.cells;
    for (int side = 0; side < 2; ++side) {
      const std::size_t child = kind.child[side];
      if (child == 0 || child >= nodes_.size() || here <= 0) continue;
      links_[number].child[side] = child;
      links_[number].inner[side] = nodes_[child].inner.count / kinds_[child].cells / here;
    }
  }

  void find_moments(std::size_t number) {
    Moments& all = moments_[number];
    all.mean[0] = 1;
    for (int depth = 1; depth <= deepest; ++depth) {
      all.mean[depth] = 1;
      for (int side = 0; side < 2; ++side) {
        const double inner = links_[number].inner[side];
        if (inner <= 0) continue;
        const Moments& below = moments_[links_[number].child[side]];
        const double likely = std::min(1.0, inner);
        all.mean[depth] += inner * below.mean[depth - 1];
        all.variance[depth] +=
            inner * below.variance[depth - 1] + likely * (1 - likely) * below.mean[depth - 1] * below.mean[depth - 1];
      }
    }
  }

  /// E[min(opened, X)] for a normal X.
  [[nodiscard]] double at_most_opened(double mean, double variance) const {
    const double most = opened_;
    if (variance < 1e-9) return std::min(most, mean);
    const double deviation = std::sqrt(variance);
    const double z = (mean - most) / deviation;
    if (z > 6) return most;
    if (z < -6) return mean;
    const double excess = deviation * (z * std::erfc(-z / std::numbers::sqrt2) / 2 +
                                       std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi));
    return std::min(mean - excess, std::min(mean, most));
  }

  /// Joins an inner node of this kind and inner nodes below it to a wide node, the least deep ones first. Inner nodes
  /// that are not joined become tops of wide nodes. Returns the number joined, including the top.
  double open(std::size_t number) {
    const Moments& moments = moments_[number];
    frontier_.assign(1, {number, 1.0});
    double opened = 0;
    for (int depth = 0; depth <= std::min(opened_, deepest) && !frontier_.empty(); ++depth) {
      double ready = 0;
      for (const auto& [kind, count] : frontier_) ready += count;
      const double more = at_most_opened(moments.mean[depth], moments.variance[depth]) - opened;
      const double part = std::clamp(more / ready, 0.0, 1.0);
      opened += part * ready;
      next_.clear();
      for (const auto& [kind, count] : frontier_) {
        if (depth > 0) wide_[kind] += wide_[number] * count * (1 - part);
        for (int side = 0; side < 2; ++side)
          add_to_next(links_[kind].child[side], count * part * links_[kind].inner[side]);
      }
      frontier_.swap(next_);
    }
    for (const auto& [kind, count] : frontier_) wide_[kind] += wide_[number] * count;
    return opened;
  }

  void add_to_next(std::size_t kind, double count) {
    if (count <= 1e-9) return;
    for (auto& [other, sum] : next_)
      if (other == kind) {
        sum += count;
        return;
      }
    next_.emplace_back(kind, count);
  }

  const std::vector<LevelNodes>& nodes_;
  const std::vector<CellKind>& kinds_;
  int opened_ = 1;  ///< maximum number of inner nodes of the binary tree in one wide node
  std::vector<Link> links_;
  std::vector<Moments> moments_;
  std::vector<double> wide_;
  std::vector<std::pair<std::size_t, double>> frontier_;
  std::vector<std::pair<std::size_t, double>> next_;
};

}  // namespace box_tree

namespace {

using box_tree::CellKind;
using box_tree::Leaves;
using box_tree::LevelNodes;
using box_tree::Sums;
using box_tree::TreeCounts;
using box_tree::Widening;

}  // namespace

/// The counts of all fan-outs for samples in a cube, or on its faces, that do not depend on the fan-out.
class BoxTreeShapes::Tree {
 public:
  /// `samples` in the cube, or on its faces, each of which stands for `in_one`.
  Tree(int dimension, const Valid<Workload>& workload, const box_tree::SampleCube& cube, double samples, double in_one,
       int leaf, Engine engine)
      : kinds_(box_tree::cell_kinds(dimension, samples)), blocks_(ray_blocks(workload.rays, workload.samples, engine)) {
    nodes_ = box_tree::expected_binary_tree(dimension, samples, cube.ends(), leaf, {engine, cube.margin()});
    widening_.emplace(nodes_, kinds_);
    std::optional<box_tree::ClusteredNodes> clustered;
    if (!workload.nodes.empty()) clustered.emplace(workload, engine, cube.margin() * cube.side());
    const auto crossing = [&](double discs, double surface, double volume) {
      return clustered ? clustered->crossing(discs * in_one) : cube.crossing(surface, volume);
    };
    for (std::size_t kind = 0; kind < nodes_.size(); ++kind) {
      const Sums& inner = nodes_[kind].inner;
      inner_share_.push_back(
          kind == 0 || !(inner.count > 0)
              ? 1
              : crossing(kinds_[kind].share * samples, inner.surface / inner.count, inner.volume / inner.count));
      inner_culls_.push_back(-1);
      fixed_.made += inner.count;
      for (const Leaves& leaves : nodes_[kind].leaves) {
        const double share = kind > 0 ? crossing(leaves.discs, leaves.surface, leaves.volume) : 1;
        if (kind > 0) leaf_lists_.push_back(leaves.count * share);
        fixed_.discs += leaves.count * leaves.discs * share;
        fixed_.visits += leaves.count * leaves.discs * blocks_.with_any(share, leaves.spread);
        fixed_.made += leaves.count;
      }
    }
  }

  [[nodiscard]] TreeCounts counts(int fan_out) {
    TreeCounts counts = fixed_;
    widening_->for_each(fan_out, [&](std::size_t kind, double wide, double children) {
      const double share = inner_share_[kind];
      double& culls = inner_culls_[kind];
      if (culls < 0) culls = blocks_.with_any(share);
      counts.tests += wide * children * share;
      if (kind > 0) counts.listed += wide * share;
      counts.culls += wide * children * culls;
    });
    for (const double lists : leaf_lists_) counts.listed += lists;
    return counts;
  }

 private:
  const std::vector<CellKind>& kinds_;
  RayBlocks blocks_;
  std::vector<LevelNodes> nodes_;
  std::optional<Widening> widening_;
  std::vector<double> inner_share_;  ///< by kind of cell: P of its inner nodes
  std::vector<double> inner_culls_;  ///< blocks of rays with a ray in an inner node; negative: not computed yet
  std::vector<double> leaf_lists_;   ///< rays listed for leaves, per ray
  TreeCounts fixed_;                 ///< counts that do not depend on the fan-out
};

BoxTreeShapes::BoxTreeShapes(const Valid<Workload>& workload, int leaf, Engine engine)
    : workload_(workload), engine_(engine), leaf_(leaf) {
  assert(leaf >= 1);
  const double samples = workload.samples;
  if (samples <= leaf) return;
  const int tabulated = std::min(leaf, box_tree_largest_leaf);
  // A tree with larger leaves than box_tree_largest_leaf has the nodes of a tree with leaves of that size and
  // proportionally fewer samples.
  in_one_ = static_cast<double>(leaf) / tabulated;
  const double dimension = std::clamp(workload.dimension, 2.0, 3.0);
  const box_tree::SampleCube cube(workload);
  const auto tree_in = [&](int whole) {
    return std::make_unique<Tree>(whole, workload, cube, std::round(samples / in_one_), in_one_, tabulated, engine);
  };
  if (dimension < 3) surface_ = tree_in(2);
  if (dimension > 2) volume_ = tree_in(3);
}

BoxTreeShapes::~BoxTreeShapes() = default;

Counts<double> BoxTreeShapes::counts(int fan_out) {
  assert(fan_out >= 2);
  const double rays = workload_.rays;
  const double samples = workload_.samples;
  Counts<double> counts{
      .references = samples, .placements = samples, .sorted = samples, .hits = expected_hits(workload_)};
  const double blocks = ray_blocks(rays, samples, engine_).count();
  if (samples <= leaf_) {
    counts.disc_tests = rays * samples;
    counts.visits = blocks * samples;
    counts.made = 1;
    return counts;
  }
  fan_out = std::min(fan_out, box_tree_most_children);
  TreeCounts tree = (surface_ ? surface_ : volume_)->counts(fan_out);
  if (surface_ && volume_) {
    const TreeCounts volume = volume_->counts(fan_out);
    const double weight = workload_.dimension - 2;
    for (const auto term : {&TreeCounts::tests, &TreeCounts::listed, &TreeCounts::discs, &TreeCounts::culls,
                            &TreeCounts::visits, &TreeCounts::made})
      tree.*term = std::pow(tree.*term, 3 - workload_.dimension) * std::pow(volume.*term, weight);
  }
  counts.cull_tests = rays * tree.tests;
  counts.listed = rays * tree.listed;
  counts.disc_tests = rays * std::min(samples, in_one_ * tree.discs);
  counts.visits = std::min(blocks * samples, in_one_ * tree.visits);
  counts.culls = tree.culls;
  counts.made = tree.made;
  return counts;
}

Counts<double> box_tree_counts(const Valid<Workload>& workload, const Valid<BoxTreeParameters>& parameters,
                               Engine engine) {
  return BoxTreeShapes(workload, parameters.leaf, engine).counts(parameters.fan_out);
}

}  // namespace detp::model
