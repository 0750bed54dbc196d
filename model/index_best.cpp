#include "index_best.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "disc_index.hpp"

namespace detp::model {
namespace {

constexpr double ripple = 1.6;      // how far from the minimum without ripples the least time may lie, as a factor
constexpr double most_tried = 128;  // numbers of cells in that range

/// A whole number of cells near the minimum, by golden section over their logarithm.
template <class Time>
double golden_section(const Time& time, double most_cells) {
  constexpr double golden = 0.6180339887498949;
  const auto at = [&](double log_cells) { return time(std::round(std::exp(log_cells))); };
  double low = 0;
  double high = std::log(most_cells);
  double left = high - golden * (high - low);
  double right = low + golden * (high - low);
  double left_time = at(left);
  double right_time = at(right);
  while (high - low > 0.1) {
    if (left_time <= right_time) {
      high = std::exchange(right, left);
      left = high - golden * (high - low);
      right_time = std::exchange(left_time, at(left));
    } else {
      low = std::exchange(left, right);
      right = low + golden * (high - low);
      left_time = std::exchange(right_time, at(right));
    }
  }
  return std::round(std::exp(0.5 * (low + high)));
}

}  // namespace

int best_octree_depth(const Workload& workload, const UnitCosts& costs, const IndexVariant& variant, int most_depth) {
  const std::vector<Counts<double>> depths = octree_counts_by_depth(workload, {most_depth}, variant);
  const auto best = std::min_element(depths.begin(), depths.end(), [&](const auto& a, const auto& b) {
    return price(a, costs, Technique::octree).total() < price(b, costs, Technique::octree).total();
  });
  return static_cast<int>(best - depths.begin());
}

int best_grid_cells(const Workload& workload, const UnitCosts& costs, const IndexVariant& variant, int most_cells) {
  require_count("most cells a side", most_cells, 1, 1 << 20);
  const auto time = [&](double cells) {
    return price(grid_counts(workload, {static_cast<int>(cells)}, variant), costs, Technique::grid).total();
  };
  const double middle = golden_section(time, most_cells);
  const double first = std::floor(middle / ripple);
  const double last = std::ceil(middle * ripple);
  const double step = std::max(1.0, std::floor((last - first) / most_tried));
  double best = middle;
  double best_time = time(middle);
  const auto try_all = [&](double from, double to, double by) {
    for (double cells = std::max(1.0, from); cells <= std::min(to, 1.0 * most_cells); cells += by)
      if (const double taken = time(cells); taken < best_time) {
        best = cells;
        best_time = taken;
      }
  };
  try_all(first, last, step);
  try_all(best - step, best + step, std::max(1.0, std::floor(2 * step / most_tried)));
  return static_cast<int>(best);
}

}  // namespace detp::model
