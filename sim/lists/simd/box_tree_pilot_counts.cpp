#include <algorithm>
#include <array>
#include <deque>
#include <optional>
#include <utility>

#include "box_tree_pilot.hpp"

namespace detp::sim::stream {

/// Follows the builder: decides which nodes are leaves, and joins the others into wide nodes.
class BoxTreePilot::Evaluation {
 public:
  Evaluation(const BoxTreePilot& pilot, const BoxTreeParameters& parameters, bool growth)
      : pilot_(pilot),
        growth_(growth),
        fan_out_(static_cast<std::size_t>(parameters.fan_out)),
        leaf_(std::max<std::uint32_t>(finest_leaf, static_cast<std::uint32_t>(parameters.leaf))),
        nodes_(pilot.nodes_),
        inner_(nodes_.size() - pilot.coarse_) {
    for (const Subtree& subtree : pilot.subtrees_)
      if (subtree.weight > 0) decide_leaves(subtree);
  }

  PilotCounts counts() {
    const auto discs = static_cast<double>(pilot_.discs_.tree.discs.size());
    is_inner(resolved(0)) ? visit(resolved(0), 0) : add_leaf(0, 1);
    const double scale = pilot_.rays_ / pilot_.sampled_;
    for (const auto per_ray : {&Counts<double>::cull_tests, &Counts<double>::listed, &Counts<double>::disc_tests})
      counts_.*per_ray *= scale;
    for (RadiusGrowth* const growth : {&found_.cull_tests, &found_.listed, &found_.disc_tests}) {
      growth->first *= scale;
      growth->second *= scale;
    }
    counts_.visits = std::min(counts_.visits, discs * pilot_.blocks_.count());
    counts_.loaded = pilot_.rays_;
    if (pilot_.segments_) counts_.segments = pilot_.rays_;
    counts_.hits = pilot_.hits_;
    counts_.doubtful = scale * pilot_.doubtful_;
    counts_.sorted = counts_.placements = counts_.references = discs;
    counts_.made = made_in_top(0);
    found_.relative_error = pilot_.relative_error_;
    return found_;
  }

 private:
  [[nodiscard]] std::uint32_t resolved(std::uint32_t node) const {
    const std::uint32_t refined = pilot_.known_[node].refined;
    return refined > 0 ? refined : node;
  }

  [[nodiscard]] WideChild child_at(std::uint32_t node) const {
    const std::uint32_t child = resolved(node);
    return {child, is_inner(child) ? area(child) : -1.0F};
  }

  [[nodiscard]] bool is_inner(std::uint32_t node) const {
    if (node < pilot_.coarse_) return !nodes_[node].leaf() && nodes_[node].count > leaf_;
    return inner_[node - pilot_.coarse_] != 0;
  }

  /// As `join` decides, with leaves of up to leaf_ discs. Children come after their parent.
  void decide_leaves(const Subtree& subtree) {
    costs_.resize(subtree.last - subtree.first);
    for (std::uint32_t i = subtree.last; i-- > subtree.first;) {
      const BinaryNode& node = nodes_[i];
      float& cost = costs_[i - subtree.first];
      cost = static_cast<float>(node.count) * area(i);
      if (node.leaf() || node.count <= leaf_) continue;
      const NodeCost decided(area(i), node.count, area(i + 1) + area(node.right),
                             costs_[i + 1 - subtree.first] + costs_[node.right - subtree.first]);
      cost = decided.cost;
      inner_[i - pilot_.coarse_] = decided.inner ? 1 : 0;
    }
  }

  [[nodiscard]] float area(std::uint32_t node) const { return pilot_.area_[node]; }

  /// How the surface of a node's box grows with the radius, relative to the surface (PilotCounts::at). The root's list
  /// does not grow: it has all rays.
  [[nodiscard]] RadiusGrowth growth_of(std::uint32_t node) const {
    const FloatBox& box = nodes_[node].box;
    const float surface = area(node);
    if (!growth_ || node == 0 || node == resolved(0) || !(surface > 0)) return {};
    std::array<float, 3> side{};
    std::array<float, 3> more{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      side[axis] = box.high[axis] - box.low[axis];
      more[axis] = std::min(side[axis], 2 * pilot_.radius_);
    }
    const float first = more[0] * (side[1] + side[2]) + more[1] * (side[2] + side[0]) + more[2] * (side[0] + side[1]);
    const float second = more[0] * more[1] + more[1] * more[2] + more[2] * more[0];
    return {first / surface, second / surface};
  }

  static void add(const RadiusGrowth& relative, double tests, RadiusGrowth& sum) {
    sum.first += tests * relative.first;
    sum.second += tests * relative.second;
  }

  void add_leaf(std::uint32_t node, double weight) {
    const Known& known = pilot_.known_[node];
    const double tests = weight * known.rays * nodes_[node].count;
    counts_.disc_tests += tests;
    add(growth_of(node), tests, found_.disc_tests);
    counts_.visits += weight * known.blocks * nodes_[node].count;
  }

  void visit(std::uint32_t node, std::size_t level) {
    if (children_.size() <= level) children_.resize(level + 1);
    open_wide_node(
        node, fan_out_,
        [this](std::uint32_t inner) { return std::pair(child_at(inner + 1), child_at(nodes_[inner].right)); },
        children_[level]);
    const Known& here = pilot_.known_[node];
    const RadiusGrowth here_grows = growth_of(node);
    for (std::size_t i = 0; i < children_[level].size(); ++i) {
      const std::uint32_t child = children_[level][i].node;
      const Known& known = pilot_.known_[child];
      if (known.weight == 0) continue;  // below a subtree that was not drawn
      found_.nodes += known.weight;
      counts_.cull_tests += known.weight * here.rays;
      add(here_grows, known.weight * here.rays, found_.cull_tests);
      counts_.culls += known.weight * here.blocks;
      counts_.listed += known.weight * known.rays;
      add(growth_of(child), known.weight * known.rays, found_.listed);
      if (!is_inner(child)) {
        if (nodes_[child].count <= leaf_ || child >= pilot_.coarse_) add_leaf(child, known.weight);
      } else if (nodes_[child].count > most_in_a_subtree || child >= pilot_.coarse_) {
        visit(child, level + 1);  // not the root of a subtree that was not drawn
      }
    }
  }

  /// Nodes of the binary tree at and below a coarse node. A subtree has as many for each disc as the drawn ones.
  [[nodiscard]] double made_in_top(std::uint32_t node) {
    const BinaryNode& here = nodes_[node];
    if (here.count <= leaf_) return 1;
    if (here.count <= most_in_a_subtree) return made_for_each_disc() * here.count;
    return 1 + made_in_top(node + 1) + made_in_top(here.right);
  }

  [[nodiscard]] double made_for_each_disc() {
    if (made_for_each_disc_) return *made_for_each_disc_;
    double made = 0;
    double discs = 0;
    for (const Subtree& subtree : pilot_.subtrees_)
      if (subtree.weight > 0) {
        made += made_below(subtree.first);
        discs += nodes_[subtree.first].count;
      }
    return *(made_for_each_disc_ = made / discs);
  }

  [[nodiscard]] double made_below(std::uint32_t node) const {
    return is_inner(node) ? 1 + made_below(node + 1) + made_below(nodes_[node].right) : 1;
  }

  const BoxTreePilot& pilot_;
  bool growth_;
  std::size_t fan_out_;
  std::uint32_t leaf_;
  const std::vector<BinaryNode>& nodes_;
  std::vector<char> inner_;
  std::vector<float> costs_;
  std::deque<std::vector<WideChild>> children_;  ///< of the wide nodes on the way down
  std::optional<double> made_for_each_disc_;
  PilotCounts found_;
  Counts<double>& counts_ = found_.counts;
};

PilotCounts BoxTreePilot::counts(const BoxTreeParameters& parameters, bool growth) const {
  return Evaluation(*this, parameters, growth).counts();
}

}  // namespace detp::sim::stream
