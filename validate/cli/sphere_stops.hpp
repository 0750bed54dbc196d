#pragma once

#include "detp/model/vocabulary/form.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::cli {

/// The two stops k of a sphere cache of ratio Q that a user may want.
struct SphereStops {
  std::int64_t max = 0;   ///< the form's own k: how many spheres can hold a disc
  std::int64_t best = 0;  ///< the fastest by that form; 0 where max is 0
};

/// Throws as model::sphere_count and model::best_stop do.
[[nodiscard]] SphereStops sphere_stops(const Workload& workload, const UnitCosts& costs, model::Form form,
                                       RadiusRatio ratio);

}  // namespace detp::cli
