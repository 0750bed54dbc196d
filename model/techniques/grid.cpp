#include <algorithm>
#include <cmath>

#include "detp/model/closed_form/closed_form.hpp"
#include "detp/model/closed_form/fastest.hpp"
#include "detp/model/closed_form/reasons.hpp"
#include "detp/model/disc_index/disc_index.hpp"

namespace detp::model {
namespace {

constexpr double slow_factor = 3;  // stop when a time is this many times the smallest
constexpr double ripple = 1.4;     // the minimum is within this factor of the best step
constexpr int most_tried = 64;     // largest number of cell counts tried in that range

/// Factor by which the time of the first grids tried may exceed that of the best one. The largest in 1100 random
/// workloads: 1.33.
constexpr double good_grid_excess = 1.5;

Counts<double> grid(const Valid<Workload>& workload, const GridParameters& parameters) {
  return grid_counts(workload, parameters);
}

/// Considers grids with the numbers of cells of a search, from 1 to 65 536 along the longest side.
struct GridSearch {
  const Valid<Workload>& workload;
  const SearchLimits& limits;
  Fastest<GridParameters> fastest;

  [[nodiscard]] bool fits(int cells) const {
    return cells <= 1 << 16 && index_cells(workload, cells).count() <= limits.most_cells &&
           !limits.stop.stop_requested();
  }
  double consider(int cells) { return fastest.consider({cells}, grid_counts(workload, {cells})); }
  void consider_all(int from, int to, int step) {
    for (int cells = std::max(1, from); cells <= to && fits(cells); cells += step) consider(cells);
  }
  [[nodiscard]] int best_cells() const { return fastest.best() ? fastest.best()->cells : 0; }
};

/// A grid with m cells a side over a cube takes w n_P E/m² + v m for each of n_R P(cube) lines, and b n_P E to build,
/// with the UnitCosts w, v, b. E, the mean number of cells that a disc overlaps, is a polynomial in m with positive
/// coefficients. Every term is convex in m, so there is one minimum. The time ripples around this curve because of the
/// ends of the box, mostly if the box is not a cube: then the last cells extend outside the box. So m is tried in steps
/// of 10 % until the time is three times the smallest so far, then up to 64 values within a factor of 1.4 of the best
/// m, then the neighbours of the best m.
///
/// If another technique's time is known, 1, 2, 4 … cells come first; if the best of them is too slow, it is returned.
///
/// Accuracy   on 95 % of 1200 cubes and boxes, some of them a thousand times longer than high, the time is the smallest
///            that any of seven searches found; at worst it is 7.7 % longer.
std::optional<FoundParameters> best_grid(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                         const FixedParameters&, const SearchLimits& limits) {
  if (limits.fastest < HUGE_VAL) {
    GridSearch quick{workload, limits, {costs, Technique::grid, limits}};
    for (int cells = 1; quick.fits(cells); cells *= 2)
      if (quick.consider(cells) > slow_factor * quick.fastest.least()) break;
    if (!quick.fastest.best()) return std::nullopt;
    if (quick.fastest.least() > good_grid_excess * limits.fastest) return not_tuned(*quick.fastest.best());
  }
  GridSearch all{workload, limits, {costs, Technique::grid, limits}};
  for (int cells = 1; all.fits(cells); cells = std::max(cells + 1, static_cast<int>(1.1 * cells)))
    if (all.consider(cells) > slow_factor * all.fastest.least()) break;
  const auto from = static_cast<int>(all.best_cells() / ripple);
  const auto to = static_cast<int>(all.best_cells() * ripple);
  const int step = std::max(1, (to - from) / most_tried);
  all.consider_all(from, to, step);
  const int best = all.best_cells();
  all.consider_all(best - step, best + step, std::max(1, step / 8));
  return tuned(all.fastest.best());
}

void uncounted_grid(const Valid<Workload>& workload, const Parameters& parameters, Reasons& reasons) {
  uncounted_scene(workload, reasons);
  range_of_samples(workload, reasons);
  reasons.range("cells a side", std::get<GridParameters>(parameters).cells, 2, 128);
}

}  // namespace

TechniqueModel model_grid() { return {predicted<GridParameters, grid>, best_grid, uncounted_grid}; }

}  // namespace detp::model
