#include "index_best.hpp"

#include <algorithm>

#include "detp/model/disc_index/disc_index.hpp"
#include "fastest.hpp"

namespace detp::model {
namespace {

constexpr double slow_factor = 3;  // stop when a time is this many times the smallest
constexpr double ripple = 1.4;     // the minimum is within this factor of the best step
constexpr int most_tried = 64;     // largest number of cell counts tried in that range

bool fits_limits(const Valid<Workload>& workload, int cells, const SearchLimits& limits) {
  return cells <= 1 << 16 && index_cells(workload, cells).count() <= limits.most_cells && !limits.stop.stop_requested();
}

}  // namespace

std::optional<int> best_octree_depth(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                     const SearchLimits& limits) {
  Fastest<int> fastest(costs, Technique::octree, limits);
  int depth = 0;
  for_each_octree_depth(workload, {limits.most_depth}, {}, [&](const Counts<double>& counts) {
    fastest.consider(depth++, counts);
    return !fastest.excludes(counts);
  });
  return fastest.best();
}

std::optional<GoodGrid> good_grid_cells(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                        const SearchLimits& limits) {
  Fastest<int> fastest(costs, Technique::grid, limits);
  for (int cells = 1; fits_limits(workload, cells, limits); cells *= 2)
    if (fastest.consider(cells, grid_counts(workload, {cells})) > slow_factor * fastest.least()) break;
  const auto best = fastest.best();
  return best ? std::optional(GoodGrid{*best, fastest.least()}) : std::nullopt;
}

std::optional<int> best_grid_cells(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                   const SearchLimits& limits) {
  Fastest<int> fastest(costs, Technique::grid, limits);
  const auto fits = [&](int cells) { return fits_limits(workload, cells, limits); };
  const auto consider = [&](int cells) { return fastest.consider(cells, grid_counts(workload, {cells})); };
  const auto consider_all = [&](int from, int to, int step) {
    for (int cells = std::max(1, from); cells <= to && fits(cells); cells += step) consider(cells);
  };
  for (int cells = 1; fits(cells); cells = std::max(cells + 1, static_cast<int>(1.1 * cells)))
    if (consider(cells) > slow_factor * fastest.least()) break;
  const int middle = fastest.best().value_or(0);
  const auto from = static_cast<int>(middle / ripple);
  const auto to = static_cast<int>(middle * ripple);
  const int step = std::max(1, (to - from) / most_tried);
  consider_all(from, to, step);
  const int best = fastest.best().value_or(0);
  consider_all(best - step, best + step, std::max(1, step / 8));
  return fastest.best();
}

}  // namespace detp::model
