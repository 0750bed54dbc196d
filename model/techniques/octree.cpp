#include "detp/model/closed_form/closed_form.hpp"
#include "detp/model/closed_form/fastest.hpp"
#include "detp/model/closed_form/reasons.hpp"
#include "detp/model/disc_index/disc_index.hpp"

namespace detp::model {
namespace {

Counts<double> octree(const Valid<Workload>& workload, const OctreeParameters& parameters) {
  return octree_counts(workload, parameters);
}

/// The best depth for top-down traversal, whatever the traversal is. Tries depths from 1 up (an octree of depth 0 is brute force, and
/// the unit costs of octrees are not measured with it), until the nodes, the
/// insertions and one test for each hit of a deeper octree would take longer than the best so far. Predicts each level
/// once.
std::optional<FoundParameters> best_octree(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                           const FixedParameters&, const SearchLimits& limits) {
  Fastest<OctreeParameters> fastest(costs, Technique::octree, limits);
  int depth = 0;
  for_each_octree_depth(workload, {limits.most_depth}, {}, [&](const Counts<double>& counts) {
    const int this_depth = depth++;
    if (this_depth == 0 && limits.most_depth > 0) return true;
    fastest.consider({this_depth}, counts);
    return !fastest.excludes(counts);
  });
  return tuned(fastest.best());
}

void uncounted_octree(const Valid<Workload>& workload, const Parameters& parameters, Reasons& reasons) {
  uncounted_scene(workload, reasons);
  range_of_samples(workload, reasons);
  reasons.range("depth", std::get<OctreeParameters>(parameters).depth, 1, 7);
}

}  // namespace

TechniqueModel model_octree() { return {predicted<OctreeParameters, octree>, best_octree, uncounted_octree}; }

}  // namespace detp::model
