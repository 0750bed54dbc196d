#include "box_tree_boxes.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <numbers>

namespace detp::model::box_tree {
namespace {

using std::numbers::pi;

/// E[y]/(L + d), tabulated on first use.
class MissingTable {
 public:
  static constexpr int steps = 4;              // of d/L, per octave
  static constexpr int rows = 28 * steps + 1;  // from 2⁻¹⁴ to 2¹⁴
  static constexpr int exact = 64;             // m = 1, 2 … 64, then four values per octave
  static constexpr int columns = exact + 4 * 16;

  MissingTable() {
    for (int row = 0; row < rows; ++row) tabulate(row);
  }

  [[nodiscard]] const double* row(int number) const { return table_[number].data(); }

 private:
  static constexpr int points = 128;

  /// ∫₀^v P(d - reach < w) dw for d = 1.
  static double below(double v) {
    if (v >= 1) return pi / 4 + v - 1;
    const double t = 1 - v;
    return pi / 4 - (t * std::sqrt(1 - t * t) + std::asin(t)) / 2;
  }

  void tabulate(int row) {
    const double ratio = std::exp2(static_cast<double>(row) / steps - 14);
    const double side = 1 / ratio;  // divided by d
    auto& entries = table_[row];
    entries.fill(0);
    for (int point = 0; point < points; ++point) {
      // Substitutes y = (L + d) t⁴, because most of the integral is near 0.
      const double t = (point + 0.5) / points;
      const double y = (side + 1) * std::pow(t, 4);
      const double weight = 4 * std::pow(t, 3) / points;
      const double outside = std::max(0.0, 1 - (below(y) - below(std::max(0.0, y - side))) / side);
      double power = 1;
      for (int column = 0; column < exact; ++column) entries[column] += weight * (power *= outside);
      std::array<double, 4> between;
      for (int i = 0; i < 4; ++i) between[i] = std::pow(power, std::exp2((i + 1) / 4.0));
      for (int column = exact; column < columns; ++column) {
        double& next = between[(column - exact) % 4];
        entries[column] += weight * next;
        next *= next;
      }
    }
  }

  std::array<std::array<double, columns>, rows> table_;
};

const MissingTable& missing_table() {
  static const auto table = std::make_unique<const MissingTable>();
  return *table;
}

}  // namespace

CellBoxes::Row CellBoxes::row_of(double side, double radius, double log_radius) {
  using Table = MissingTable;
  const double log_ratio = side > 0 ? log_radius - std::ilogb(side) : Table::rows;
  const double at = std::clamp(Table::steps * (14 + log_ratio), 0.0, Table::rows - 1.0);
  const int row = std::min(static_cast<int>(at), Table::rows - 2);
  return {missing_table().row(row), at - row, side + radius, side / 2 + radius * (1 - pi / 4)};
}

double CellBoxes::missing(const Row& row, double discs) {
  using Table = MissingTable;
  const double at = discs <= 1              ? 0
                    : discs <= Table::exact ? discs - 1
                                            : Table::exact - 1 + 4 * std::log2(discs / Table::exact);
  const int column = std::min(static_cast<int>(std::min<double>(at, Table::columns)), Table::columns - 2);
  const double weight = std::min(1.0, at - column);
  const double* low = row.entries + column;
  const double* high = low + Table::columns;
  const double there = row.scale * (low[0] + row.weight * (high[0] - low[0]));
  const double next = row.scale * (low[1] + row.weight * (high[1] - low[1]));
  return weight * next + (1 - weight) * (column == 0 ? row.single : there);
}

CellBoxes::CellBoxes(const CellKind& cell, double disc_radius, const Listing& listing)
    : radius_(disc_radius), listing_(listing), flat_(row_of(0, disc_radius, 0)) {
  const double log_radius = std::log2(disc_radius);
  std::array<double, 3> on_faces{};
  double area = 0;
  for (int axis = 0; axis < 3; ++axis)
    area += on_faces[axis] = cell.touched[axis] * cell.side[(axis + 1) % 3] * cell.side[(axis + 2) % 3];
  for (int axis = 0; axis < 3; ++axis) {
    Axis& along = axes_[axis];
    along.length = cell.side[axis];
    along.uniform = row_of(along.length, disc_radius, log_radius);
    along.touched = cell.touched[axis];
    if (along.touched == 0) continue;
    const double on_either = on_faces[axis] / area;
    along.on_face = on_either / along.touched;
    along.uniform_share = 1 - on_either;
    if (along.uniform_share <= 0) continue;
    along.log_off_face = std::log1p(-along.on_face);
    along.log_on_faces = std::log(on_either);
  }
}

double CellBoxes::side_of(const Axis& axis, double discs) const {
  const double whole = axis.length + 2 * radius_;
  if (axis.touched == 0) return whole - 2 * missing(axis.uniform, discs);
  if (axis.uniform_share <= 0) return axis.touched == 1 ? 2 * (radius_ - missing(flat_, discs)) : whole;
  // Discs on a face determine the box's end there. The uniform discs determine it if no disc is on that face.
  const double none_on = std::exp(discs * axis.log_off_face);
  const double uniform = missing(axis.uniform, axis.uniform_share * discs);
  const double at_face = (1 - none_on) * missing(flat_, axis.on_face * discs) + none_on * uniform;
  if (axis.touched == 2) return std::max(0.0, whole - 2 * at_face);
  const double all_on = std::exp(discs * axis.log_on_faces);
  const double at_end = (1 - all_on) * uniform + all_on * (axis.length + missing(flat_, discs));
  return std::max(0.0, whole - at_face - at_end);
}

void CellBoxes::products(std::span<double> products) const {
  assert(products.size() <= MissingTable::exact);
  std::array<std::array<double, MissingTable::exact>, 3> side;
  for (std::size_t i = 0; i < 3; ++i) {
    const Axis& axis = axes_[i];
    assert(axis.touched == 0 || (axis.touched == 1 && axis.uniform_share <= 0));
    const double whole = axis.touched == 0 ? axis.length + 2 * radius_ : 2 * radius_;
    const Row row = axis.touched == 0 ? axis.uniform : flat_;
    const double* low = row.entries;
    const double* high = low + MissingTable::columns;
    side[i][0] = whole - 2 * row.single;
    for (std::size_t m = 1; m < products.size(); ++m)
      side[i][m] = whole - 2 * (row.scale * (low[m] + row.weight * (high[m] - low[m])));
  }
  for (std::size_t m = 0; m < products.size(); ++m) {
    products[m] = side[0][m] * side[1][m];
    products[m] += side[1][m] * side[2][m];
    products[m] += side[2][m] * side[0][m];
  }
}

double CellBoxes::variance_of(const Axis& axis, double discs) const {
  constexpr double of_reaches = 8.0 / 3 - pi * pi / 4;  // variance of one disc's side over d²
  const double uniform = axis.uniform_share * discs;
  const double length = uniform > 1 ? axis.length / (uniform + 1) : 0;
  return 2 * length * length * (uniform - 1) / (uniform + 2) + of_reaches * radius_ * radius_ / discs;
}

MeanBox CellBoxes::operator()(double discs) const {
  constexpr double for_missing = 0.28768207245178093 / pi;  // ln(4/3)/π
  std::array<double, 3> side{};
  std::array<double, 3> variance{};
  for (int i = 0; i < 3; ++i) {
    side[i] = side_of(axes_[i], discs);
    variance[i] = variance_of(axes_[i], discs);
  }
  MeanBox box;
  double squares = 0;
  box.volume = 1;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    box.products += side[i] * side[j];
    box.spread += variance[i] * (std::pow(side[j] + side[k], 2) + variance[j]);
  }
  box.spread /= box.products * box.products;
  double grown = 0;
  for (double& one : side) one += 2 * listing_.margin;
  for (int i = 0; i < 3; ++i) {
    grown += side[i] * side[(i + 1) % 3];
    squares += side[i] * side[i];
    box.volume *= side[i];
  }
  box.surface = 2 * (grown + (listing_.engine == Engine::simd ? for_missing * squares : 0));
  return box;
}

}  // namespace detp::model::box_tree
