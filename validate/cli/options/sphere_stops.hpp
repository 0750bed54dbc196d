#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::cli {

/// The number of spheres k of a sphere cache if --spheres is not a number.
enum class SphereStop {
  max,  ///< SphereStops::max
  best  ///< SphereStops::best
};

/// Two numbers of spheres k for a sphere cache of ratio Q.
struct SphereStops {
  std::int64_t max = 0;   ///< number of spheres that can hold a disc, by the published or the corrected form
  std::int64_t best = 0;  ///< number of spheres with the least predicted time, by the same form; 0 if max is 0
};

/// The number of spheres k of a form: that of SphereStops::max, without the search for the best.
[[nodiscard]] std::int64_t own_spheres(const Workload& workload, Form form, RadiusRatio ratio);

/// Throws as model::sphere_count and model::best_stop do.
[[nodiscard]] SphereStops sphere_stops(const Workload& workload, const UnitCosts& costs, Form form, RadiusRatio ratio);

}  // namespace detp::cli
