#include "sphere_stops.hpp"

#include "detp/model/optimum/best_published_ratio.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"

namespace detp::cli {

std::int64_t own_spheres(const Workload& workload, Form form, RadiusRatio ratio) {
  return model::sphere_count(form, ratio, {workload.disc_radius}, {workload.sphere_radius});
}

SphereStops sphere_stops(const Workload& workload, const UnitCosts& costs, Form form, RadiusRatio ratio) {
  const std::int64_t max = own_spheres(workload, form, ratio);
  if (max == 0) return {};
  return {max, form == Form::published ? model::published::best_stop(workload, costs, ratio)
                                       : model::best_stop(workload, costs, ratio).spheres};
}

}  // namespace detp::cli
