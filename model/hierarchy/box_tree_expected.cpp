#include "box_tree_expected.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "box_tree_sah_leaves.hpp"

namespace detp::model::box_tree {
namespace {

/// ln(n (n - 1) … (n - k + 1)/n^k).
double log_falling(double n, double k) {
  constexpr double many = 1e5;  // above this, n! would lose digits
  if (n < many) return std::lgamma(n + 1) - std::lgamma(n - k + 1) - k * std::log(n);
  return -k * (k - 1) / (2 * n) * (1 + (2 * k - 1) / (6 * n));
}

/// P(k) for k = 0 … last of a binomial distribution.
void binomial(double trials, double share, int last, std::vector<double>& out) {
  out.assign(static_cast<std::size_t>(last) + 1, 0);
  if (share <= 0 || trials <= 0) {
    out[0] = 1;
    return;
  }
  if (share >= 1) {
    if (trials <= last) out[static_cast<std::size_t>(trials)] = 1;
    return;
  }
  const double mode = std::floor((trials + 1) * share);
  const int start = static_cast<int>(std::min(mode, static_cast<double>(last)));
  const double log_p = log_falling(trials, start) - std::lgamma(start + 1.0) + start * std::log(share * trials) +
                       (trials - start) * std::log1p(-share);
  const double odds = share / (1 - share);
  out[start] = std::exp(log_p);
  for (int k = start; k < last && k < trials && out[k] > 1e-14; ++k)
    out[k + 1] = out[k] * ((trials - k) * odds / (k + 1));
  for (int k = start; k > 0 && out[k] > 1e-14; --k) out[k - 1] = out[k] * (k / ((trials - k + 1) * odds));
}

/// a(m) of one kind of cells (box_tree_expected.hpp); until the terms of all parents are added, times the number of
/// cells. Empty if all cells are nodes.
using NodeProbabilities = std::vector<double>;

class ExpectedLevels {
 public:
  ExpectedLevels(int dimension, double samples, const BoxEnds& ends, int leaf, const Listing& listing)
      : kinds_(cell_kinds(dimension, samples)),
        samples_(samples),
        ends_(ends),
        leaf_(leaf),
        listing_(listing),
        most_(std::max(leaf, largest_sah_leaf)),
        later_kinds_(dimension == 2 ? 6 : 0),
        sah_leaf_model_(dimension, samples, ends, leaf),
        node_probabilities_(kinds_.size()),
        reached_(kinds_.size(), false),
        nodes_(kinds_.size()) {
    reached_[0] = true;
  }

  std::vector<LevelNodes> level_nodes() && {
    double largest = 0;
    std::size_t end = 0;
    for (std::size_t number = 0; number < kinds_.size(); ++number) {
      if (reached_[number]) {
        visit(number);
        double count = nodes_[number].inner.count;
        for (const Leaves& leaves : nodes_[number].leaves) count += leaves.count;
        largest = std::max(largest, count);
        if (count > 1e-3 * largest) end = number + 1;
        if (number >= end + later_kinds_) break;
      }
    }
    nodes_.resize(end);
    return std::move(nodes_);
  }

 private:
  /// The largest number of discs considered for a cell that expects `expected` discs.
  [[nodiscard]] int most_of(double expected) const {
    return static_cast<int>(std::min<double>(most_, expected + deviations * std::sqrt(expected) + 10));
  }

  [[nodiscard]] bool are_all_inner(const CellKind& cell) const {
    return almost_all_exceed(most_, samples_ * cell.share);
  }

  void visit(std::size_t number) {
    const CellKind& cell = kinds_[number];
    LevelNodes& nodes = nodes_[number];
    if (are_all_inner(cell)) {
      nodes.inner.add(cell.cells, CellBoxes(cell, ends_, listing_)(samples_ * cell.share));
    } else {
      NodeProbabilities& node_probability = node_probabilities_[number];
      if (node_probability.empty())
        node_probability.assign(static_cast<std::size_t>(most_) + 1, 1);
      else
        for (double& value : node_probability) value /= cell.cells;
      count_nodes(cell, node_probability, nodes);
    }
    if (cell.child[0] == 0) return;
    for (const std::size_t child : cell.child) reached_[child] = true;
    set_inner_probabilities(number);
    add_to_child(number, 0, cell.child[0] == cell.child[1] ? 2 : 1);
    if (cell.child[0] != cell.child[1]) add_to_child(number, 1, 1);
  }

  /// The share of leaves among nodes with `discs` discs.
  [[nodiscard]] double leaf_share(const SahLeaves* sah_leaves, int discs) const {
    if (discs <= leaf_) return 1;
    if (sah_leaves == nullptr || discs > largest_sah_leaf) return 0;
    return sah_leaves->share[discs];
  }

  void count_nodes(const CellKind& cell, const NodeProbabilities& node_probability, LevelNodes& nodes) {
    nodes.leaves.reserve(24);
    const double expected = samples_ * cell.share;
    const int last = most_of(expected);
    binomial(samples_, cell.share, last, probability_);
    const SahLeaves* sah_leaves = sah_leaf_model_.for_cell(cell);
    const CellBoxes boxes(cell, ends_, listing_);
    const Halves halves = halves_of(cell);
    double above = 1 - probability_[0];
    double discs_above = expected;
    constexpr double few = 0.01;
    for (int first = 1; first <= last;) {
      // Neighbouring numbers of discs have about equal boxes, so evaluate them together; in the tails, more of them.
      int end = first;
      double weight = 0;
      double discs = 0;
      double leaves = 0;
      double leaf_boxes = 0;
      const auto belongs = [&](int m) {
        if (m > last || (first <= leaf_ && m > leaf_)) return false;
        return m == first || m < first + first / 5 || (m < first + first / 2 && weight < few);
      };
      for (int m = first; belongs(m); end = ++m) {
        above -= probability_[m];
        discs_above -= m * probability_[m];
        const double present = probability_[m] * node_probability[m];
        weight += present;
        discs += m * present;
        const double leaf_part = leaf_share(sah_leaves, m);
        leaves += present * leaf_part;
        leaf_boxes += present * leaf_part * (m > leaf_ && sah_leaves != nullptr ? sah_leaves->box[m] : 1);
      }
      if (weight * cell.cells > 1e-12) {
        discs /= weight;
        MeanBox box = boxes(discs);
        const double split = discs > leaf_ ? split_share(cell, halves, discs, box) : 1;
        add(nodes, cell.cells * weight * split, discs, box, leaves / weight, leaf_boxes / weight);
      }
      first = end;
    }
    if (above > 1e-9) nodes.inner.add(cell.cells * above, boxes(discs_above / above));
  }

  /// Mean boxes around the discs in either half.
  using Halves = std::optional<std::array<CellBoxes, 2>>;

  static constexpr double most_in_one_half = 10;  ///< discs; if there are more, both halves have some

  [[nodiscard]] Halves halves_of(const CellKind& cell) const {
    if (leaf_ >= most_in_one_half || cell.child[0] == 0) return {};
    const CellBoxes first(kinds_[cell.child[0]], ends_, listing_);
    if (cell.child[0] == cell.child[1]) return {{first, first}};
    return {{first, CellBoxes(kinds_[cell.child[1]], ends_, listing_)}};
  }

  /// The share of cells with discs in both halves. Only these cells are nodes. Changes `box` from the mean box of all
  /// cells to that of the nodes.
  static double split_share(const CellKind& cell, const Halves& halves, double discs, MeanBox& box) {
    if (!halves || discs > most_in_one_half) return 1;
    double split = 1;
    MeanBox rest = box;
    for (std::size_t side = 0; side < 2; ++side) {
      const double all = std::pow(cell.part[side], discs);
      const MeanBox half = (*halves)[side](discs);
      split -= all;
      rest.surface -= all * half.surface;
      rest.volume -= all * half.volume;
    }
    if (split < 1e-9) return 0;
    box.surface = std::max(0.0, rest.surface / split);
    box.volume = std::max(0.0, rest.volume / split);
    return split;
  }

  /// Adds nodes of about `discs` discs. `leaves` is the share of leaves, `leaf_boxes` their share of all surface
  /// and volume.
  static void add(LevelNodes& nodes, double cells, double discs, const MeanBox& box, double leaves, double leaf_boxes) {
    if (leaves > 0) {
      const double size = leaf_boxes / leaves;
      nodes.leaves.push_back({leaves * cells, discs, size * box.surface, size * box.volume, box.spread});
    }
    nodes.inner.count += (1 - leaves) * cells;
    nodes.inner.surface += (1 - leaf_boxes) * cells * box.surface;
    nodes.inner.volume += (1 - leaf_boxes) * cells * box.volume;
  }

  /// Adds this parent's contribution to a(m) of a child.
  void add_to_child(std::size_t number, int side, double times) {
    const CellKind& parent = kinds_[number];
    const CellKind& child = kinds_[parent.child[side]];
    if (are_all_inner(child)) return;
    NodeProbabilities& sum = node_probabilities_[parent.child[side]];
    if (sum.empty()) sum.assign(static_cast<std::size_t>(most_) + 1, 0);
    const double cells = times * parent.cells;
    const double expected = samples_ * child.share;
    const double rest = 1 - child.share;
    const double sibling = rest > 0 ? std::min(1.0, (parent.share - child.share) / rest) : 1;
    // The sibling's number of discs is distributed over the discs outside the child. This distribution is computed
    // once, for the child's expected number of discs, and shifted for other numbers.
    const int first = std::max(1, static_cast<int>(expected - deviations * std::sqrt(expected)));
    const int last = most_of(expected);
    const double others = std::floor(samples_ - expected);
    binomial(others, sibling, most_of(others * sibling), probability_);
    const NodeProbabilities& node_probability = node_probabilities_[number];
    convolve(static_cast<std::size_t>(first - 1), static_cast<std::size_t>(std::min(last, most_) + 1));
    const double none = probability_[0];
    for (int m = first; m <= last; ++m) {
      const double at = std::clamp(m + (expected - m) * sibling, first - 1.0, last + 0.999);
      const auto low = static_cast<std::size_t>(at);
      double share = conditional_[low] + (at - static_cast<double>(low)) * (conditional_[low + 1] - conditional_[low]);
      if (none > 0 && m > leaf_)
        share += none * ((node_probability.empty() ? 1 : node_probability[m]) - inner_probability_[m]);
      sum[m] += cells * std::clamp(share, 0.0, 1.0);
    }
  }

  /// Sets, for each number of discs, the share of a kind's cells that are inner nodes.
  void set_inner_probabilities(std::size_t number) {
    if (are_all_inner(kinds_[kinds_[number].child[0]]) && are_all_inner(kinds_[kinds_[number].child[1]])) return;
    const NodeProbabilities& node_probability = node_probabilities_[number];
    const SahLeaves* sah_leaves = sah_leaf_model_.for_cell(kinds_[number]);
    inner_probability_.assign(2 * static_cast<std::size_t>(most_) + 3, 1);
    for (int m = 0; m <= most_; ++m) {
      inner_probability_[m] = (1 - leaf_share(sah_leaves, m)) * (node_probability.empty() ? 1 : node_probability[m]);
    }
  }

  /// Σ P(s) inner_probability_(m + s) for m = first … last.
  void convolve(std::size_t first, std::size_t last) {
    conditional_.assign(static_cast<std::size_t>(most_) + 2, 0);
    double rest = 1;
    if (leaf_ >= largest_sah_leaf) {  // all nodes with more discs than a leaf are inner nodes
      for (const double p : probability_) rest -= p;
      double sum = std::max(0.0, rest);
      std::size_t s = probability_.size();
      for (std::size_t m = 0; m <= last; ++m) {
        const std::size_t least = m > static_cast<std::size_t>(leaf_) ? 0 : static_cast<std::size_t>(leaf_) + 1 - m;
        while (s > least) sum += probability_[--s];
        conditional_[m] = sum;
      }
      return;
    }
    for (std::size_t s = 0; s < probability_.size(); ++s) {
      const double p = probability_[s];
      if (p < 1e-7) continue;
      rest -= p;
      const double* from = &inner_probability_[s];
      double* to = conditional_.data();
      for (std::size_t m = first; m <= last; ++m) to[m] += p * from[m];
    }
    for (std::size_t m = first; m <= last; ++m) conditional_[m] += std::max(0.0, rest);
  }

  const std::vector<CellKind>& kinds_;
  double samples_;
  const BoxEnds& ends_;
  int leaf_;
  Listing listing_;
  int most_;
  /// number of kinds after one with few nodes before which there may be one with more: in a cube, the number of nodes
  /// grows and then falls from level to level
  std::size_t later_kinds_;
  SahLeafModel sah_leaf_model_;
  std::vector<NodeProbabilities> node_probabilities_;
  std::vector<bool> reached_;
  std::vector<LevelNodes> nodes_;
  std::vector<double> probability_;
  std::vector<double> inner_probability_;
  std::vector<double> conditional_;
};

}  // namespace

std::vector<LevelNodes> expected_binary_tree(int dimension, double samples, const BoxEnds& ends, int leaf,
                                             const Listing& listing) {
  return ExpectedLevels(dimension, samples, ends, leaf, listing).level_nodes();
}

}  // namespace detp::model::box_tree
