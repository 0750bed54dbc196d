#include "choose.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "best_ratio.hpp"
#include "disc_index.hpp"
#include "predict.hpp"

namespace detp::model {
namespace {

/// Keeps the fastest of the candidates it is shown that stay within the limits.
class Fastest {
 public:
  Fastest(const Workload& workload, const UnitCosts& costs, const SearchLimits& limits)
      : workload_(workload), costs_(costs), limits_(limits) {}

  void consider(const Candidate& candidate) {
    const Ranked ranked = assess(workload_, candidate, costs_);
    if (ranked.counts.references > limits_.most_references) return;
    if (!best_ || ranked.time.total() < best_->time.total()) best_ = ranked;
  }

  [[nodiscard]] const std::optional<Ranked>& best() const { return best_; }

 private:
  const Workload& workload_;
  const UnitCosts& costs_;
  const SearchLimits& limits_;
  std::optional<Ranked> best_;
};

}  // namespace

Ranked assess(const Workload& workload, const Candidate& candidate, const UnitCosts& costs) {
  const Counts<double> counts = predict(workload, candidate);
  return {candidate, counts, price(counts, costs)};
}

std::vector<Ranked> rank(const Workload& workload, const UnitCosts& costs, const SearchLimits& limits) {
  std::vector<Ranked> ranking{assess(workload, {Technique::brute_force, BruteForceParameters{}}, costs)};
  if (workload.disc_radius < workload.sphere_radius) {
    const BestRatio best = best_ratio_and_stop(workload, costs);
    if (best.spheres > 0)
      ranking.push_back(assess(
          workload, {Technique::sphere_cache, SphereCacheParameters{best.ratio, best.spheres, SampleOrder::lebesgue}},
          costs));
  }
  Fastest octree(workload, costs, limits);
  for (int depth = 0; depth <= limits.most_depth; ++depth)
    octree.consider({Technique::octree, OctreeParameters{depth}});
  if (octree.best()) ranking.push_back(*octree.best());
  Fastest grid(workload, costs, limits);
  for (int cells = 1; index_cells(workload, cells).count() <= limits.most_cells && cells <= 1 << 16;
       cells = std::max(cells + 1, static_cast<int>(1.1 * cells)))
    grid.consider({Technique::grid, GridParameters{cells}});
  if (grid.best()) ranking.push_back(*grid.best());
  std::stable_sort(ranking.begin(), ranking.end(),
                   [](const Ranked& a, const Ranked& b) { return a.time.total() < b.time.total(); });
  return ranking;
}

}  // namespace detp::model
