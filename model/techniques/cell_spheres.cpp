#include <algorithm>

#include "detp/model/closed_form/closed_form.hpp"
#include "detp/model/closed_form/fastest.hpp"
#include "detp/model/closed_form/reasons.hpp"
#include "detp/model/hierarchy/cell_spheres.hpp"

namespace detp::model {
namespace {

std::optional<FoundParameters> best_cells(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                          const FixedParameters&, const SearchLimits& limits) {
  Fastest<CellSpheresParameters> fastest(costs, Technique::cell_spheres, limits);
  int depth = 0;
  const double blocks = ray_blocks(workload.rays, workload.samples, limits.engine).count();
  for_each_cell_sphere_depth(workload, {std::min(limits.most_depth, 16)}, [&](Counts<double> counts) {
    counts.culls *= blocks;
    counts.visits *= blocks;
    fastest.consider({depth++}, counts);
    return !fastest.excludes(counts) && !limits.stop.stop_requested();
  });
  return tuned(fastest.best());
}

void uncounted_cells(const Valid<Workload>& workload, const Parameters& parameters, Reasons& reasons) {
  uncounted_scene(workload, reasons);
  range_of_samples(workload, reasons);
  reasons.range("depth", std::get<CellSpheresParameters>(parameters).depth, 1, 6);
}

}  // namespace

TechniqueModel model_cell_spheres() {
  return {in_blocks<CellSpheresParameters, cell_sphere_counts>, best_cells, uncounted_cells};
}

}  // namespace detp::model
