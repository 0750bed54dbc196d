#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <stop_token>
#include <string_view>

/// The ways to estimate the irradiance at a sample from photon paths. A new one is a record here and a file.
namespace detp::sim {

class Index;
class NearTriangles;
struct Mesh;

/// Makes an index over the mesh in which the photon paths were traced (surface.hpp).
using PrepareSurfaces = std::unique_ptr<Index>(const Mesh& mesh, const std::stop_token& stop,
                                               std::shared_ptr<const NearTriangles> triangles);
PrepareSurfaces prepare_area_corrected, prepare_triangle_hits;

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
  bool finds_pairs = false;            ///< by any exact technique
  bool uses_radius = false;            ///< of the discs
  bool all_at_once = false;            ///< results of parts of the rays cannot be added
  bool keeps_areas = false;            ///< what it measures once serves all later searches of the same discs
  bool needs_scene = false;            ///< with its lights: no photons are traced
  PrepareSurfaces* prepare = nullptr;  ///< of estimators that look at surfaces

  [[nodiscard]] constexpr bool needs_mesh() const { return prepare != nullptr; }
};

inline constexpr std::array estimators{
    EstimatorRecord{.estimator = Estimator::disc, .name = "disc", .finds_pairs = true, .uses_radius = true},
    EstimatorRecord{.estimator = Estimator::variable_radius,
                    .name = "variable-radius",
                    .finds_pairs = true,
                    .uses_radius = true,
                    .all_at_once = true},
    EstimatorRecord{.estimator = Estimator::nearest, .name = "nearest", .all_at_once = true},
    EstimatorRecord{.estimator = Estimator::area_corrected,
                    .name = "area-corrected",
                    .uses_radius = true,
                    .keeps_areas = true,
                    .prepare = prepare_area_corrected},
    EstimatorRecord{.estimator = Estimator::triangle_hits, .name = "triangle-hits", .prepare = prepare_triangle_hits},
    EstimatorRecord{.estimator = Estimator::gather, .name = "gather", .needs_scene = true}};

[[nodiscard]] constexpr const EstimatorRecord& record_of(Estimator estimator) {
  return estimators[static_cast<std::size_t>(estimator)];
}

[[nodiscard]] constexpr std::string_view name(Estimator estimator) { return record_of(estimator).name; }

}  // namespace detp::sim
