#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::cli {

/// The two numbers of spheres k that a user may want for a sphere cache of ratio Q.
struct SphereStops {
  std::int64_t max = 0;   ///< the form's own k: the number of spheres that can hold a disc
  std::int64_t best = 0;  ///< the fastest by that form; 0 if max is 0
};

/// Throws as model::sphere_count and model::best_stop do.
[[nodiscard]] SphereStops sphere_stops(const Workload& workload, const UnitCosts& costs, Form form, RadiusRatio ratio);

}  // namespace detp::cli
