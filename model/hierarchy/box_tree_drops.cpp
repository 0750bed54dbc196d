#include "box_tree_drops.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace detp::model::box_tree {
namespace {

using Row = Dropped::Row;

// Constants of sim/lists/simd/disc_tree.cpp. The costs of lists are halved there too, because about one of two splits
// is joined to a wide node.
constexpr double cull_cost = 1.6;
constexpr double list_cost = 0.5;

double normal_density(double z) { return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi); }
double normal_below(double z) { return std::erfc(-z / std::numbers::sqrt2) / 2; }

/// The distribution of m discs over two halves that are equally likely for each disc.
const auto& halves() {
  static const auto table = [] {
    std::array<Row, most_dropped + 1> rows{};
    rows[0][0] = 1;
    for (int m = 1; m <= most_dropped; ++m)
      for (int k = 0; k <= m; ++k) rows[m][k] = (rows[m - 1][k] + (k > 0 ? rows[m - 1][k - 1] : 0)) / 2;
    return rows;
  }();
  return table;
}

/// m^0.7
const Row& powers() {
  static const auto table = [] {
    Row row;
    for (int m = 0; m <= most_dropped; ++m) row[m] = std::pow(m, 0.7);
    return row;
  }();
  return table;
}

/// Almost no cell has more discs than this.
int most_discs(double expected) {
  return static_cast<int>(std::clamp(expected + deviations * std::sqrt(expected) + 10, 28.0, 1.0 * most_dropped));
}

/// Sets the share of dropped nodes with two discs. Pairs with a small area A are dropped: children > (2 - 1.6) A.
/// Returns the expected cost.
double drop_pair(Dropped& level, double area, double children) {
  constexpr double shape = 4;
  const double y = std::min(700.0, shape * children / ((2 - cull_cost) * area));
  const double rest = std::exp(-y) * (1 + y * (1 + y / 2 * (1 + y / 3)));
  const double share = 1 - rest;
  const double part = 1 - rest - std::exp(-y) * std::pow(y, shape) / 24;
  level.share[2] = share;
  level.box[2] = share > 1e-9 ? part / share : 0;
  return 2 * area * part + rest * children + cull_cost * area * (1 - part);
}

/// Sets the share of dropped nodes with `discs` discs. Returns the expected cost.
double drop(Dropped& level, int discs, double area, double children, double deviation, double of_points) {
  const double less = cull_cost * area + children - discs * area;
  if (std::abs(less) > deviations * deviation) {
    level.share[discs] = less > 0 ? 1 : 0;
    return discs * area + std::min(less, 0.0);
  }
  deviation *= std::pow(std::min(1.0, of_points), 0.35);
  const double z = less / deviation;
  const double share = normal_below(z);
  const double density = normal_density(z);
  level.share[discs] = share;
  level.box[discs] = std::max(0.02, 1 - 0.3 * deviation / (area * (discs - cull_cost)) * density / share);
  return discs * area + less * (1 - share) - deviation * density;
}

}  // namespace

bool all_more_than(int discs, double expected) { return expected - deviations * std::sqrt(expected) > discs; }

Drops::Drops(int dimension, double samples, double radius, int leaf)
    : radius_(radius),
      leaf_(leaf),
      on_faces_(dimension == 2),
      least_side_(radius / 64),
      // In cells that expect fewer discs than this, almost none has more discs than a leaf.
      least_discs_(std::exp((std::log(1e-4) + std::lgamma(leaf + 2)) / leaf) / (dimension == 2 ? 3 : 1)) {
  if (leaf >= most_dropped) return;
  std::vector<const CellKind*> cells;  // by number of halvings
  for (const CellKind& kind : cell_kinds(dimension)) {
    if (on_faces_ && kind.side[2] > 0) continue;
    cells.resize(static_cast<std::size_t>(kind.halvings) + 1, nullptr);
    cells[kind.halvings] = &kind;
  }
  std::size_t end = 0;
  while (end + 1 < cells.size() && matters(*cells[end], samples)) ++end;
  levels_.resize(end + 1);
  Row area{};
  Row cost{};
  for (std::size_t level = end + 1; level-- > 0;) {
    const double expected = samples * cells[level]->share;
    if (all_more_than(most_dropped, expected)) break;
    const int most = most_discs(on_faces_ ? 3 * expected : expected);  // a corner has parts on three faces
    if (level == end)
      start(*cells[level], area, cost);
    else
      halve(*cells[level], most, area, cost);
  }
}

const Dropped* Drops::of(const CellKind& cell) const {
  return levels_.empty() ? nullptr : &levels_[std::min(static_cast<std::size_t>(cell.halvings), levels_.size() - 1)];
}

bool Drops::matters(const CellKind& cell, double samples) const {
  return samples * cell.share > least_discs_ && cell.side[0] > least_side_;
}

/// Starts with cells so small that all nodes are dropped.
void Drops::start(const CellKind& cell, Row& area, Row& cost) {
  Dropped& level = levels_.back();
  level.share.fill(1);
  level.box.fill(1);
  const CellBoxes boxes(cell, radius_);
  for (int m = 1; m <= most_dropped; ++m) {
    area[m] = boxes(m).products;
    cost[m] = m * area[m];
  }
}

/// Fitted: how much the two sides of the heuristic's inequality differ between nodes.
double Drops::spread(double pairs_dropped) const {
  return 0.215 * (on_faces_ ? 1.1 : 1) * (leaf_ > 1 ? 1.13 : 1) * (1 + 1.2 * pairs_dropped * (1 - pairs_dropped));
}

/// The area that the mean box would have if the discs were points, as a share of its area.
double Drops::of_points(const CellKind& cell, int discs, double area) const {
  const auto& side = cell.side;
  const double flat = side[0] * side[1] + (on_faces_ ? 0 : side[1] * side[2] + side[2] * side[0]);
  return flat * std::pow((discs - 1.0) / (discs + 1.0), 2) / area;
}

/// Computes the cell's areas and costs from those of its halves.
void Drops::halve(const CellKind& cell, int most, Row& area, Row& cost) {
  Dropped& level = levels_[cell.halvings];
  level.share.fill(1);
  level.box.fill(1);
  const Row half_area = area;
  const Row half_cost = cost;
  Row either;
  for (int m = 1; m <= most; ++m) either[m] = 2 * (list_cost * half_area[m] + half_cost[m]);
  const double deviation = spread(leaf_ > 1 ? 1 : levels_[cell.halvings + 1].share[2]);
  const CellBoxes boxes(cell, radius_);
  double none = 1;  // probability that one half has all discs
  for (int m = 1; m <= most; ++m, none /= 2) {
    area[m] = boxes(m).products;
    if (m <= leaf_) {
      cost[m] = m * area[m];
      continue;
    }
    const Row& weight = halves()[m];
    double children = 0;
    const int off = static_cast<int>(2.5 * std::sqrt(m)) + 1;  // five deviations
    for (int k = std::max(1, m / 2 - off); k <= std::min(m - 1, m / 2 + off); ++k) children += weight[k] * either[k];
    children /= 1 - none;
    const double split_area = std::max((area[m] - none * half_area[m]) / (1 - none), 1e-300);
    const double least = m == 2 ? drop_pair(level, split_area, children)
                                : drop(level, m, split_area, children, deviation * split_area * powers()[m],
                                       of_points(cell, m, area[m]));
    cost[m] = none * half_cost[m] + (1 - none) * least;
  }
}

}  // namespace detp::model::box_tree
