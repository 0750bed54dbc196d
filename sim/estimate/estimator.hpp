#pragma once

#include <array>
#include <cstddef>
#include <string_view>

/// The ways to estimate the irradiance at a sample from photon paths. Each is a record here and a file.
namespace detp::sim {

enum class Estimator {
  disc,             ///< rays that cross the sample's disc, over the disc's area
  variable_radius,  ///< the same with a radius for each disc, from the rays near it
  nearest,          ///< the nearest photons, over the area of the circle that holds them
  area_corrected,   ///< photons in a sphere around the sample, over the area of the surfaces in it
  triangle_hits,    ///< photons that met a triangle, over its area; averages at vertices
  gather            ///< backward paths from the sample to the lights: no photons
};

struct EstimatorRecord {
  Estimator estimator;
  std::string_view name;
  bool finds_pairs = false;  ///< by any exact technique
  bool needs_mesh = false;
  bool needs_scene = false;  ///< its lights too: no photons are traced
};

inline constexpr std::array estimators{
    EstimatorRecord{.estimator = Estimator::disc, .name = "disc", .finds_pairs = true},
    EstimatorRecord{.estimator = Estimator::variable_radius, .name = "variable-radius", .finds_pairs = true},
    EstimatorRecord{.estimator = Estimator::nearest, .name = "nearest"},
    EstimatorRecord{.estimator = Estimator::area_corrected, .name = "area-corrected", .needs_mesh = true},
    EstimatorRecord{.estimator = Estimator::triangle_hits, .name = "triangle-hits", .needs_mesh = true},
    EstimatorRecord{.estimator = Estimator::gather, .name = "gather", .needs_scene = true}};

[[nodiscard]] constexpr const EstimatorRecord& record_of(Estimator estimator) {
  return estimators[static_cast<std::size_t>(estimator)];
}

[[nodiscard]] constexpr std::string_view name(Estimator estimator) { return record_of(estimator).name; }

}  // namespace detp::sim
