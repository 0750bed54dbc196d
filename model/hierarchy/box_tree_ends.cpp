#include "box_tree_ends.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <mutex>
#include <numbers>

namespace detp::model::box_tree {
namespace {

using std::numbers::pi;

constexpr std::size_t exact = BoxEnds::most_exact;  // m = 1, 2 … 64, then four values per octave
constexpr std::size_t columns = exact + 4 * 16;

using Entries = std::array<double, columns>;

/// ∫₀^v P(d - reach < w) dw for d = r = 1.
double below_one(double v) {
  if (v <= 0) return 0;
  if (v >= 1) return pi / 4 + v - 1;
  const double t = 1 - v;
  return pi / 4 - (t * std::sqrt(1 - t * t) + std::asin(t)) / 2;
}

/// Adds the part of E[y] between two values of y, for d = 1, L = side and each m. `below(v)` is ∫₀^v P(d - reach < w) dw. `points` is a multiple of 8.
template <class Below>
void integrate(double side, double from, double to, int points, const Below& below, Entries& entries) {
  constexpr int lanes = 8;  // points at a time: their powers do not wait for each other
  for (int first = 0; first < points; first += lanes) {
    std::array<double, lanes> weight{};
    std::array<double, lanes> outside{};
    std::array<double, lanes> power{};
    for (int lane = 0; lane < lanes; ++lane) {
      // Substitutes y = from + (to - from) t⁴, because most of the integral is near its lower end.
      const double t = (first + lane + 0.5) / points;
      const double y = from + (to - from) * std::pow(t, 4);
      weight[lane] = (to - from) * 4 * std::pow(t, 3) / points;
      outside[lane] = std::max(0.0, 1 - (below(y) - below(y - side)) / side);
      power[lane] = 1;
    }
    for (std::size_t column = 0; column < exact; ++column)
      for (int lane = 0; lane < lanes; ++lane) entries[column] += weight[lane] * (power[lane] *= outside[lane]);
    std::array<std::array<double, lanes>, 4> between{};
    for (int lane = 0; lane < lanes; ++lane)
      for (int i = 0; i < 4; ++i) between[i][lane] = std::pow(power[lane], std::exp2((i + 1) / 4.0));
    for (std::size_t column = exact; column < columns; ++column) {
      std::array<double, lanes>& next = between[(column - exact) % 4];
      for (int lane = 0; lane < lanes; ++lane) {
        entries[column] += weight[lane] * next[lane];
        next[lane] *= next[lane];
      }
    }
  }
}

}  // namespace

/// For equal radii; each row is made on first use, since a choice needs few of them.
class BoxEnds::Table {
 public:
  static constexpr int steps = 4;              // of d/L, per octave
  static constexpr int rows = 28 * steps + 1;  // from 2⁻¹⁴ to 2¹⁴

  static Table& get() {
    static const auto table = std::make_unique<Table>();
    return *table;
  }

  /// This row, and the next one behind it.
  [[nodiscard]] const double* row(int number) {
    for (const int one : {number, number + 1}) std::call_once(made_[one], [&] { make(one); });
    return table_[number].data();
  }

 private:
  void make(int row) {
    const double side = std::exp2(14 - static_cast<double>(row) / steps);
    integrate(side, 0, side + 1, 128, below_one, table_[row]);
    for (double& entry : table_[row]) entry /= side + 1;
  }

  std::array<Entries, rows> table_{};
  std::array<std::once_flag, rows> made_;
};

/// For classes of radii, a row for each L.
class BoxEnds::MixedTable {
 public:
  explicit MixedTable(std::vector<RadiusClass> classes) : classes_(std::move(classes)) {
    const double largest = classes_.front().radius;
    for (RadiusClass& one : classes_) one.radius /= largest;
  }

  /// `side` is L/d.
  const double* row(double side) {
    const auto [place, is_new] = rows_.try_emplace(side);
    if (is_new) tabulate(side, place->second[0]);
    return place->second[0].data();
  }

 private:
  using TwoRows = std::array<Entries, 2>;  ///< the second, zeros, has no weight

  /// Integrates in parts, because G(y) rises steeply where discs of the next class begin to reach.
  void tabulate(double side, Entries& entries) const {
    double from = 0;
    for (std::size_t i = 1; i <= classes_.size(); ++i) {
      const double to = i < classes_.size() ? 1 - classes_[i].radius : side + 1;
      integrate(
          side, from, to, i == 1 ? 64 : 16, [&](double v) { return below(v); }, entries);
      from = to;
    }
    for (double& entry : entries) entry /= side + 1;
  }

  /// ∫₀^v P(d - reach < w) dw for d = 1.
  [[nodiscard]] double below(double v) const {
    double sum = 0;
    for (const RadiusClass& one : classes_) {
      const double inside = v - (1 - one.radius);
      if (inside <= 0) break;  // smaller discs do not reach this far either
      sum += one.share * one.radius * table().at(inside / one.radius);
    }
    return sum;
  }

  /// below_one(), interpolated: the square root and the arcsine would take most of the time.
  class BelowTable {
   public:
    BelowTable() {
      for (int i = 0; i <= cells; ++i) values_[i] = below_one(square(i));
    }

    [[nodiscard]] double at(double v) const {
      if (v >= 1) return pi / 4 + v - 1;
      const double place = cells * std::sqrt(v);  // near 0 the function grows with the power 1.5
      const int i = static_cast<int>(place);
      const double weight = (v - square(i)) / (square(i + 1) - square(i));
      return values_[i] + weight * (values_[i + 1] - values_[i]);
    }

   private:
    static constexpr int cells = 256;
    static double square(int i) { return static_cast<double>(i) * i / (cells * cells); }

    std::array<double, cells + 1> values_;
  };

  static const BelowTable& table() {
    static const BelowTable made;
    return made;
  }

  std::vector<RadiusClass> classes_;
  std::map<double, TwoRows> rows_;
};

double BoxEnds::Row::missing(double discs) const {
  const double at = discs <= 1 ? 0 : discs <= exact ? discs - 1 : exact - 1 + 4 * std::log2(discs / exact);
  const std::size_t column = std::min(static_cast<std::size_t>(std::min<double>(at, columns)), columns - 2);
  const double weight = std::min(1.0, at - static_cast<double>(column));
  const double* low = entries_ + column;
  const double* high = low + next_row;
  const double there = scale_ * (low[0] + weight_ * (high[0] - low[0]));
  const double next = scale_ * (low[1] + weight_ * (high[1] - low[1]));
  return weight * next + (1 - weight) * (column == 0 ? single_ : there);
}

void BoxEnds::Row::missing_up_to(std::span<double> out) const {
  assert(out.size() <= exact);
  const double* low = entries_;
  const double* high = low + next_row;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = scale_ * (low[i] + weight_ * (high[i] - low[i]));
  if (!out.empty()) out[0] = single_;
}

BoxEnds::BoxEnds(double radius) : largest_(radius), log_largest_(std::log2(radius)), rms_(radius), mean_(radius) {
  constexpr double of_reaches = 8.0 / 3 - pi * pi / 4;
  extent_variance_ = of_reaches * radius * radius;
}

BoxEnds::BoxEnds(std::vector<RadiusClass> classes) : BoxEnds(classes.at(0).radius) {
  double squares = 0;
  mean_ = 0;
  for (const RadiusClass& one : classes) {
    mean_ += one.share * one.radius;
    squares += one.share * one.radius * one.radius;
  }
  rms_ = std::sqrt(squares);
  extent_variance_ = 8.0 / 3 * squares - pi * pi / 4 * mean_ * mean_;
  mixed_ = std::make_unique<MixedTable>(std::move(classes));
}

BoxEnds::~BoxEnds() = default;

BoxEnds::Row BoxEnds::row(double side) const {
  static_assert(Row::next_row == columns);
  constexpr double half_range = 14;
  const double log_ratio = side > 0 ? log_largest_ - std::ilogb(side) : 2 * half_range;
  Row row;
  row.scale_ = side + largest_;
  row.single_ = side / 2 + largest_ - pi / 4 * mean_;
  if (mixed_) {
    row.entries_ = mixed_->row(std::exp2(-std::clamp(log_ratio, -half_range, half_range)));
    return row;
  }
  const double at = std::clamp(Table::steps * (half_range + log_ratio), 0.0, Table::rows - 1.0);
  const int number = std::min(static_cast<int>(at), Table::rows - 2);
  row.entries_ = Table::get().row(number);
  row.weight_ = at - number;
  return row;
}

}  // namespace detp::model::box_tree
