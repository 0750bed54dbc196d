#include <fmt/format.h>

#include <cmath>

#include "detp/model/closed_form/closed_form.hpp"
#include "detp/model/closed_form/reasons.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/sphere_cache/rebuild_law.hpp"
#include "detp/model/sphere_cache/sphere_cache.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"

namespace detp::model {
namespace {

/// Factor by which the time with the best of eight ratios may exceed that with the best one. The largest in 1100 random
/// workloads: 1.35 (best_ratio.hpp).
constexpr double good_ratio_excess = 1.5;

Counts<double> published_cache(const Valid<Workload>& workload, const SphereCacheParameters& parameters) {
  require_rebuild_law(parameters.order);
  return published::counts(workload, {parameters.ratio}, parameters.spheres);
}

/// A large disc has the spheres around its small neighbours made again. So all discs count as large as the largest: the
/// counts are an upper bound.
Workload as_large(Workload workload) {
  workload.disc_radius = largest_radius(workload);
  workload.radii.clear();
  return workload;
}

Counts<double> corrected_cache(const Valid<Workload>& workload, const Valid<SphereCacheParameters>& parameters) {
  if (workload.radii.empty()) return sphere_cache_counts(workload, parameters);
  Counts<double> counts = sphere_cache_counts(as_large(workload), parameters);
  counts.hits = expected_hits(workload);
  return counts;
}

std::optional<FoundParameters> best_cache(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                          const FixedParameters& fixed, const SearchLimits& limits) {
  if (!workload.radii.empty()) return best_cache(as_large(workload), costs, fixed, limits);
  const auto ratio = fixed.value<double>("ratio");
  const auto spheres = fixed.value<std::int64_t>("spheres");
  // No sphere holds a disc.
  if (workload.disc_radius >= workload.sphere_radius)
    return FoundParameters{SphereCacheParameters{ratio.value_or(published_ratio), spheres.value_or(0)}};
  if (limits.fastest < HUGE_VAL && fixed.values.empty()) {
    const double others = limits.fastest - time_at_any_ratio(workload, costs);
    const BestRatio good = good_ratio_below(workload, costs, others);
    if (good.spheres > 0 && good.time > good_ratio_excess * others)
      return not_tuned(SphereCacheParameters{good.ratio, good.spheres});
  }
  const BestRatio best = ratio     ? best_stop(workload, costs, {*ratio})
                         : spheres ? best_ratio_for(workload, costs, *spheres)
                                   : best_ratio_and_stop(workload, costs);
  return FoundParameters{SphereCacheParameters{ratio.value_or(best.ratio), spheres.value_or(best.spheres)}};
}

void uncounted_cache(const Valid<Workload>& workload, const Parameters& parameters, Reasons& reasons) {
  const auto& cache = std::get<SphereCacheParameters>(parameters);
  if (cache.spheres == 0) return;  // brute force
  uncounted_scene(workload, reasons);
  range_of_samples(workload, reasons);
  reasons.range("Q", cache.ratio, 0.3, 0.9);
  const auto count = [&](Form form) {
    return sphere_count(form, {cache.ratio}, {workload.disc_radius}, {workload.sphere_radius});
  };
  if (cache.spheres > count(Form::published))
    reasons.add(fmt::format("k {}: only {} spheres hold a disc", cache.spheres, count(Form::corrected)));
  if (cache.order == SampleOrder::none) reasons.add("samples in no order: only sorted ones were counted");
}

}  // namespace

TechniqueModel model_sphere_cache() {
  return {in_blocks<SphereCacheParameters, corrected_cache>, best_cache, uncounted_cache};
}

TechniqueModel model_sphere_cache_published() {
  return {predicted<SphereCacheParameters, published_cache>, best_cache, uncounted_cache};
}

}  // namespace detp::model
