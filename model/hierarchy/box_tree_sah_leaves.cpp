#include "box_tree_sah_leaves.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace detp::model::box_tree {
namespace {

using Row = SahLeaves::Row;

double normal_density(double z) { return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi); }
double normal_below(double z) { return std::erfc(-z / std::numbers::sqrt2) / 2; }

/// The distribution of m discs over two halves that are equally likely for each disc.
const auto& halves() {
  static const auto table = [] {
    std::array<Row, largest_sah_leaf + 1> rows{};
    rows[0][0] = 1;
    for (int m = 1; m <= largest_sah_leaf; ++m)
      for (int k = 0; k <= m; ++k) rows[m][k] = (rows[m - 1][k] + (k > 0 ? rows[m - 1][k - 1] : 0)) / 2;
    return rows;
  }();
  return table;
}

/// m^0.7
const Row& powers() {
  static const auto table = [] {
    Row row;
    for (int m = 0; m <= largest_sah_leaf; ++m) row[m] = std::pow(m, 0.7);
    return row;
  }();
  return table;
}

/// Almost no cell has more discs than this.
int most_discs(double expected) {
  return static_cast<int>(std::clamp(expected + deviations * std::sqrt(expected) + 10, 28.0, 1.0 * largest_sah_leaf));
}

// A table for nodes with 2 … 6 discs: share, box and cost (validate/tools/box_tree_sah_leaves_table.cpp).
constexpr int most_in_table = 6;
constexpr std::size_t small_row = 3 * (most_in_table - 1);
constexpr std::size_t small_radii = 21;              // d over the cell's longest side, 2⁻⁹, 2^{-8.5} … 2
constexpr std::size_t small_shapes = 2 + 3 + 3 + 2;  // cells on a face, in the volume, at an edge; smallest cells
#include "box_tree_sah_leaves.inc"

int faces_of(const CellKind& cell) { return cell.touched[0] + cell.touched[1] + cell.touched[2]; }

/// Small nodes of cells of one shape, interpolated between two radii.
class SmallNodes {
 public:
  SmallNodes(const CellKind& cell, double radius) {
    const double side = std::max(cell.side[1], cell.side[2]);
    const double at = std::clamp(18 + 2 * std::log2(radius / side), 0.0, small_radii - 1.0);
    const auto row = std::min(static_cast<std::size_t>(at), small_radii - 2);
    const int faces = faces_of(cell);
    const std::size_t first = faces == 1 ? 0 : faces == 0 ? 2 : 5;
    const std::size_t cuts = (cell.side[0] < side ? 1 : 0) + (cell.side[1] < side ? 1 : 0);
    const std::size_t shape = !cell.last ? first + cuts : faces == 1 ? 8 : 9;
    row_ = small_table.data() + small_row * (small_radii * shape + row);
    weight_ = at - static_cast<double>(row);
  }

  /// Sets the leaves among nodes with `discs` discs. Returns the nodes' expected cost over their mean area.
  double set_leaf_share(SahLeaves& level, int discs) const {
    level.share[discs] = value(discs, 0);
    level.box[discs] = value(discs, 1);
    return value(discs, 2);
  }

 private:
  [[nodiscard]] double value(int discs, int which) const {
    const double* low = row_ + 3 * (discs - 2) + which;
    return low[0] + weight_ * (low[small_row] - low[0]);
  }

  const double* row_;
  double weight_;
};

/// Sets the share of nodes with `discs` discs that become leaves. Returns the expected cost.
double set_leaf_share(SahLeaves& level, int discs, double area, double children, double deviation,
                      double point_box_share) {
  const double less = box_tree_split::cull * area + children - discs * area;
  if (std::abs(less) > deviations * deviation) {
    level.share[discs] = less > 0 ? 1 : 0;
    return discs * area + std::min(less, 0.0);
  }
  deviation *= std::pow(std::min(1.0, point_box_share), 0.35);
  const double z = less / deviation;
  const double share = normal_below(z);
  const double density = normal_density(z);
  level.share[discs] = share;
  level.box[discs] = std::max(0.02, 1 - 0.3 * deviation / (area * (discs - box_tree_split::cull)) * density / share);
  return discs * area + less * (1 - share) - deviation * density;
}

}  // namespace

bool almost_all_exceed(int discs, double expected) { return expected - deviations * std::sqrt(expected) > discs; }

SahLeafModel::SahLeafModel(int dimension, double samples, const BoxEnds& ends, int leaf)
    : ends_(ends),
      leaf_(leaf),
      on_faces_(dimension == 2),
      least_side_(ends.largest_radius() / 64),
      least_discs_(std::exp((std::log(1e-4) + std::lgamma(leaf + 2)) / leaf) / (dimension == 2 ? 3 : 1)) {
  if (leaf >= largest_sah_leaf) return;
  std::vector<const CellKind*> cells;  // by number of halvings
  for (const CellKind& kind : cell_kinds(dimension, samples)) {
    if (on_faces_ && kind.side[2] > 0) continue;
    cells.resize(static_cast<std::size_t>(kind.halvings) + 1, nullptr);
    cells[kind.halvings] = &kind;
  }
  std::size_t end = 0;
  while (end + 1 < cells.size() && is_undecided(*cells[end], samples)) ++end;
  levels_.resize(end + 1);
  Row area{};
  Row cost{};
  for (std::size_t level = end + 1; level-- > 0;) {
    const double expected = samples * cells[level]->share;
    if (almost_all_exceed(largest_sah_leaf, expected)) break;
    const int most = most_discs(on_faces_ ? 3 * expected : expected);  // a corner has parts on three faces
    if (level == end)
      start_from_leaves(*cells[level], area, cost);
    else
      compute_from_halves(*cells[level], most, area, cost);
  }
}

const SahLeaves* SahLeafModel::for_cell(const CellKind& cell) {
  if (levels_.empty()) return nullptr;
  const SahLeaves& level = levels_[std::min(static_cast<std::size_t>(cell.halvings), levels_.size() - 1)];
  if (faces_of(cell) <= 1) return &level;
  at_edge_ = level;
  for (double& share : at_edge_.share) {
    const double inner_share = 1 - share;
    share *= 1 + 0.75 * inner_share * inner_share * inner_share * inner_share * inner_share;
  }
  if (leaf_ > 1) return &at_edge_;
  const SmallNodes small(cell, ends_.rms_radius());
  for (int discs = 2; discs <= most_in_table; ++discs) small.set_leaf_share(at_edge_, discs);
  return &at_edge_;
}

bool SahLeafModel::is_undecided(const CellKind& cell, double samples) const {
  return samples * cell.share > least_discs_ && cell.side[0] > least_side_;
}

/// Starts with cells so small that all nodes become leaves.
void SahLeafModel::start_from_leaves(const CellKind& cell, Row& area, Row& cost) {
  SahLeaves& level = levels_.back();
  level.share.fill(1);
  level.box.fill(1);
  const CellBoxes boxes(cell, ends_);
  boxes.products(std::span(area).subspan(1));
  for (int m = 1; m <= largest_sah_leaf; ++m) cost[m] = m * area[m];
}

/// The fitted factor of σ: all of σ except A m^0.7 (A_0/A)^0.35.
double SahLeafModel::deviation_factor(double leaf_share_of_pairs) const {
  return 0.215 * (on_faces_ ? 1.1 : 1) * (leaf_ > 1 ? 1.13 : 1) *
         (1 + 1.2 * leaf_share_of_pairs * (1 - leaf_share_of_pairs));
}

/// A_0/A: the area that the mean box would have if the discs were points, divided by its area.
double SahLeafModel::point_box_share(const CellKind& cell, int discs, double area) const {
  const auto& side = cell.side;
  const double flat = side[0] * side[1] + (on_faces_ ? 0 : side[1] * side[2] + side[2] * side[0]);
  return flat * std::pow((discs - 1.0) / (discs + 1.0), 2) / area;
}

/// Computes the cell's areas and costs from those of its halves.
void SahLeafModel::compute_from_halves(const CellKind& cell, int most, Row& area, Row& cost) {
  SahLeaves& level = levels_[cell.halvings];
  level.share.fill(1);
  level.box.fill(1);
  const Row half_area = area;
  const Row half_cost = cost;
  Row either;
  for (int m = 1; m <= most; ++m) either[m] = 2 * (box_tree_split::list * half_area[m] + half_cost[m]);
  const double deviation = deviation_factor(leaf_ > 1 ? 1 : levels_[cell.halvings + 1].share[2]);
  const CellBoxes boxes(cell, ends_);
  boxes.products(std::span(area).subspan(1, static_cast<std::size_t>(most)));
  const SmallNodes small(cell, ends_.rms_radius());
  double none = 1;  // probability that one half has all discs
  for (int m = 1; m <= most; ++m, none /= 2) {
    if (m <= leaf_) {
      cost[m] = m * area[m];
      continue;
    }
    const double split_area = std::max((area[m] - none * half_area[m]) / (1 - none), 1e-300);
    if (leaf_ == 1 && m <= most_in_table) {
      cost[m] = none * half_cost[m] + (1 - none) * split_area * small.set_leaf_share(level, m);
      continue;
    }
    const Row& weight = halves()[m];
    double children = 0;
    const int off = static_cast<int>(2.5 * std::sqrt(m)) + 1;  // five deviations
    for (int k = std::max(1, m / 2 - off); k <= std::min(m - 1, m / 2 + off); ++k) children += weight[k] * either[k];
    children /= 1 - none;
    const double least = set_leaf_share(level, m, split_area, children, deviation * split_area * powers()[m],
                                        point_box_share(cell, m, area[m]));
    cost[m] = none * half_cost[m] + (1 - none) * least;
  }
}

}  // namespace detp::model::box_tree
