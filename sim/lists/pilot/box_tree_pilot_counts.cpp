#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

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
        inner_(nodes_.size() - pilot.coarse_),
        parts_(pilot.subtrees_.size() + 1) {
    for (const Subtree& subtree : pilot.subtrees_)
      if (subtree.weight > 0) decide_leaves(subtree);
  }

  PilotCounts counts() {
    const auto discs = static_cast<double>(pilot_.discs_.tree.discs.size());
    is_inner(resolved(0)) ? visit(resolved(0), 0) : add_leaf(0, 1);
    const double scale = pilot_.rays_ / pilot_.sampled_;
    enter(top());
    for (const auto per_ray : {&Counts<double>::cull_tests, &Counts<double>::listed, &Counts<double>::disc_tests})
      counts_.*per_ray *= scale;
    for (RadiusGrowth* const growth : {&found_.cull_tests, &found_.listed, &found_.disc_tests}) {
      growth->first *= scale;
      growth->second *= scale;
    }
    counts_.visits = std::min(counts_.visits, discs * pilot_.blocks_.count());
    counts_.loaded = pilot_.rays_;
    if (pilot_.segments_) counts_.segments = pilot_.rays_;
    for (const Subtree& subtree : pilot_.subtrees_) counts_.doubtful += scale * subtree.weight * subtree.doubtful;
    counts_.hits = pilot_.given_hits_.value_or(scale * pilot_.hits_);
    counts_.sorted = counts_.placements = counts_.references = discs;
    counts_.made = made_in_top(0);
    set_errors(scale);
    return found_;
  }

 private:
  /// What was added while the nodes of a subtree were visited.
  struct Part {
    Counts<double> counts = {};
    double area_of_tests = 0;  ///< number of tests of a ray that crosses everything, times the areas of the leaves
    double area_of_culls = 0;
  };

  [[nodiscard]] std::size_t top() const { return pilot_.subtrees_.size(); }

  /// The subtree to which a node belongs, or top().
  [[nodiscard]] std::size_t part_of(std::uint32_t node) const {
    if (node < pilot_.coarse_) return top();
    if (part_ != top() && node >= pilot_.subtrees_[part_].first && node < pilot_.subtrees_[part_].last) return part_;
    std::size_t part = part_ == top() ? 0 : part_;
    while (!(node >= pilot_.subtrees_[part].first && node < pilot_.subtrees_[part].last)) ++part;
    return part;
  }

  /// From now on, what is counted belongs to another part.
  void enter(std::size_t part) {
    if (part == part_) return;
    Part& left = parts_[part_];
    for (const auto term : sampled_terms) left.counts.*term += counts_.*term - before_.counts.*term;
    left.area_of_tests += area_of_tests_ - before_.area_of_tests;
    left.area_of_culls += area_of_culls_ - before_.area_of_culls;
    before_ = {counts_, area_of_tests_, area_of_culls_};
    part_ = part;
  }

  /// The variance of a count because only some subtrees were drawn (J. Hájek, 1964: of samples with unequal probabilities).
  ///
  ///     σ² = k/(k - 3) Σ (1 - 1/w) (w y - mean of w y)²
  ///
  ///   where  k  number of drawn subtrees that stand for others, too: w > 1. With the usual k/(k - 1), two standard errors
  ///             would be too small a limit if there are few of them.
  ///          y  the subtree's count
  template <class Count>
  [[nodiscard]] double variance_of_subtrees(const Count& count) const {
    double drawn = 0;
    double sum = 0;
    for (std::size_t i = 0; i < top(); ++i) {
      const double weight = pilot_.subtrees_[i].weight;
      if (weight <= 1) continue;
      drawn += 1;
      sum += count(i);
    }
    if (drawn == 0) return 0;
    double squares = 0;
    for (std::size_t i = 0; i < top(); ++i)
      if (const double weight = pilot_.subtrees_[i].weight; weight > 1)
        squares += (1 - 1 / weight) * std::pow(count(i) - (drawn > 1 ? sum / drawn : 0), 2);
    return squares * drawn / std::max(1.0, drawn - 3);
  }

  void set_errors(double scale) {
    const RayErrors& rays = pilot_.ray_errors_;
    const BinaryNode& sparse = nodes_[rays.node];
    // Counts of a ray that crosses the node, over its expected work: of the drawn subtrees there, or of all.
    double culls = 0;
    double tests = 0;
    for (const bool everywhere : {false, true}) {
      double work = 0;
      for (std::size_t i = 0; i < top(); ++i) {
        const Subtree& subtree = pilot_.subtrees_[i];
        const std::uint32_t first = nodes_[subtree.root].first;
        if (subtree.weight == 0 || (!everywhere && (first < sparse.first || first >= sparse.first + sparse.count)))
          continue;
        work += subtree.weight * pilot_.work_[subtree.root];
        culls += parts_[i].area_of_culls;
        tests += parts_[i].area_of_tests;
      }
      if (!(work > 0)) continue;
      culls /= work;
      tests /= work;
      break;
    }
    const double work = pilot_.work_of_a_ray(rays.node);
    culls = std::max(culls, 1 / work);
    if (!(tests > 0)) tests = sparse.count / work;  // leaves hold whole subtrees: the ray is tested against all discs
    const double lists =
        rays.rays > 0 ? std::min(1.0, pilot_.blocks_.count() / rays.rays) : 0;  // that these rays share
    constexpr double of_edges = 0.03;  // of the boxes at the edge of subtrees; measured
    const double edges = top() > 1 ? of_edges : 0;
    const auto set = [&](double Counts<double>::*term, double relative, double unseen, double factor) {
      const double subtrees = variance_of_subtrees([&](std::size_t i) { return factor * parts_[i].counts.*term; });
      const double count = counts_.*term;
      found_.error.*term = std::sqrt(subtrees + (relative + edges * edges) * count * count + unseen * unseen);
    };
    set(&Counts<double>::cull_tests, rays.tests, culls * rays.work, scale);
    set(&Counts<double>::listed, rays.tests, culls * rays.work, scale);
    set(&Counts<double>::disc_tests, rays.tests, tests * rays.work, scale);
    set(&Counts<double>::culls, rays.tests, lists * culls * rays.work, 1);
    set(&Counts<double>::visits, rays.tests, lists * tests * rays.work, 1);
    found_.error.cull_tests = std::hypot(found_.error.cull_tests, scale * edge_of_tests_);
    found_.error.culls = std::hypot(found_.error.culls, guessed_culls_, edge_of_culls_);
    found_.error.visits = std::hypot(found_.error.visits, guessed_visits_);
    const auto hits = [&](std::size_t i) {
      const Subtree& subtree = pilot_.subtrees_[i];
      return scale * subtree.weight * (subtree.hits.sum - pilot_.hits_ratio_ * subtree.expected_hits);
    };
    found_.error.hits = std::sqrt(variance_of_subtrees(hits) + rays.hits * counts_.hits * counts_.hits +
                                  rays.unseen_hits * rays.unseen_hits);
    const auto doubtful = [&](std::size_t i) {
      return scale * pilot_.subtrees_[i].weight * pilot_.subtrees_[i].doubtful;
    };
    found_.error.doubtful = std::sqrt(variance_of_subtrees(doubtful) + rays.hits * counts_.doubtful * counts_.doubtful +
                                      (rays.rays > 0 ? scale * counts_.doubtful + scale * scale : 0));
    found_.error.made = std::hypot(error_of_made(), edges * counts_.made);
  }

  /// The drawn subtrees are a sample of the nodes made for each disc. They are those with most work; the others may differ
  /// by a third.
  [[nodiscard]] double error_of_made() {
    constexpr double of_others = 0.3;
    double drawn = 0;
    double discs = 0;
    double squares = 0;
    for (const Subtree& subtree : pilot_.subtrees_) {
      if (subtree.weight == 0) continue;
      const double count = nodes_[subtree.first].count;
      drawn += 1;
      discs += count;
      squares += std::pow(made_below(subtree.first) - made_for_each_disc() * count, 2);
    }
    const double others = 1 - drawn / static_cast<double>(top());
    const double all = nodes_[0].count;
    return std::hypot(all / discs * std::sqrt(squares * drawn / std::max(1.0, drawn - 3) * others),
                      of_others * others * counts_.made);
  }

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
    guessed_visits_ += weight * known.guessed * nodes_[node].count;
    area_of_tests_ += weight * area(node) * nodes_[node].count;
  }

  /// Children of a wide node over those found. Coarse leaves in subtrees that were not drawn are not opened any further.
  [[nodiscard]] double children_at_top(const std::vector<WideChild>& found) const {
    double possible = 0;
    for (const WideChild& child : found) {
      const BinaryNode& node = nodes_[child.node];
      const bool closed = child.node < pilot_.coarse_ && node.leaf() && node.count > leaf_;
      possible += closed ? static_cast<double>(node.count) / leaf_ : 1;
    }
    const auto children = static_cast<double>(found.size());
    return std::max(1.0, std::min(static_cast<double>(fan_out_), possible) / children);
  }

  void visit(std::uint32_t node, std::size_t level) {
    if (children_.size() <= level) children_.resize(level + 1);
    open_wide_node(
        node, fan_out_,
        [this](std::uint32_t inner) { return std::pair(child_at(inner + 1), child_at(nodes_[inner].right)); },
        children_[level]);
    const Known& here = pilot_.known_[node];
    const RadiusGrowth here_grows = growth_of(node);
    const bool at_top = node < pilot_.coarse_;
    const double all_children = at_top ? children_at_top(children_[level]) : 1;
    for (std::size_t i = 0; i < children_[level].size(); ++i) {
      if (at_top) enter(top());
      const std::uint32_t child = children_[level][i].node;
      const Known& known = pilot_.known_[child];
      // Of a wide node at the top, there are two estimates: that drawn subtrees stand for others, and that the children in
      // the others are known. Drawn subtrees are opened farther, at the expense of the others, so that the first is too
      // high. Their weighted mean counts; the first has the weight that was best for fan-out 16 (uniform discs, lines).
      constexpr double of_drawn = 0.25;
      const double more = known.weight - all_children;
      const double tested = at_top ? all_children + of_drawn * more : known.weight;
      if (!at_top) enter(part_of(child));
      if (at_top) {
        edge_of_tests_ += of_drawn * more * here.rays;
        edge_of_culls_ += of_drawn * more * here.blocks;
      }
      found_.nodes += tested;
      counts_.cull_tests += tested * here.rays;
      add(here_grows, tested * here.rays, found_.cull_tests);
      counts_.culls += tested * here.blocks;
      guessed_culls_ += tested * here.guessed;
      area_of_culls_ += tested * area(node);
      if (known.weight == 0) continue;  // in a subtree that was not drawn
      if (at_top) enter(part_of(child));
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

  static constexpr std::array sampled_terms{&Counts<double>::cull_tests, &Counts<double>::listed,
                                            &Counts<double>::disc_tests, &Counts<double>::culls,
                                            &Counts<double>::visits};

  const BoxTreePilot& pilot_;
  bool growth_;
  std::size_t fan_out_;
  std::uint32_t leaf_;
  const std::vector<BinaryNode>& nodes_;
  std::vector<char> inner_;
  std::vector<float> costs_;
  std::deque<std::vector<WideChild>> children_;  ///< of the wide nodes on the way down
  std::optional<double> made_for_each_disc_;
  std::vector<Part> parts_;  ///< of each subtree, then the top; before they are scaled to all rays
  std::size_t part_ = parts_.size() - 1;
  Part before_;  ///< sums when the part was entered
  double area_of_tests_ = 0;
  double area_of_culls_ = 0;
  double guessed_culls_ = 0;
  double guessed_visits_ = 0;
  double edge_of_tests_ = 0;  ///< a quarter of the difference of two estimates of cull tests at the top
  double edge_of_culls_ = 0;
  PilotCounts found_;
  Counts<double>& counts_ = found_.counts;
};

PilotCounts BoxTreePilot::counts(const BoxTreeParameters& parameters, bool growth) const {
  return Evaluation(*this, parameters, growth).counts();
}

}  // namespace detp::sim::stream
