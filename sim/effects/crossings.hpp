#pragma once

#include <numbers>
#include <stop_token>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/search/problem.hpp"

namespace detp::sim {

/// The share of uniform isotropic rays that cross a convex body: lines of μ_ℓ through S₀, or segments whose origins are
/// uniform in the samples' box (Santaló, Integral Geometry).
struct UniformRays {
  double r0 = 0;
  double path_length = 0;  ///< of segments; 0: lines
  double space = 0;        ///< volume of the samples' box, grown by d

  [[nodiscard]] double share(double volume, double area) const {
    if (!(path_length > 0)) return area / (4 * std::numbers::pi * r0 * r0);
    return (volume + path_length * area / 4) / space;
  }
  [[nodiscard]] double sphere(double radius) const {
    const double area = 4 * std::numbers::pi * radius * radius;
    return share(area * radius / 3, area);
  }
  /// A disc of any orientation.
  [[nodiscard]] double disc(double radius, bool front_facing) const {
    return share(0, (front_facing ? 1 : 2) * std::numbers::pi * radius * radius);
  }
  /// The radius of the sphere that this share of the rays cross.
  [[nodiscard]] double radius_for(double wanted) const {
    double low = 0;
    double high = r0;
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (sphere(middle) < wanted ? low : high) = middle;
    }
    return high;
  }
};

/// The uniform rays of the workload.
[[nodiscard]] UniformRays uniform_rays(const Workload& workload);

/// Pairs of some rays and spheres of one radius around samples.
struct Crossings {
  double radius = 0;         ///< of the spheres: a hundredth of uniform rays cross one
  double spheres = 0;        ///< share of the pairs in which the ray crosses the sphere
  double discs = 0;          ///< share in which it also crosses the sphere's disc in the sample's tangent plane
  double spheres_error = 0;  ///< standard error, relative
  double ratio_error = 0;    ///< of discs / spheres, relative
};

/// Counts the pairs of 512 rays and 512 samples. Throws Stopped if a stop was requested.
[[nodiscard]] Crossings count_crossings(const Problem& problem, const UniformRays& uniform,
                                        const std::stop_token& stop = {});

}  // namespace detp::sim
