#pragma once

#include <numbers>

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::sim {

class EffectSample;

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

/// A quotient of two counts.
struct CountedRatio {
  double value = 1;
  double standard_error = 0;
};

/// How many rays cross spheres around samples. Each value is over that of uniform rays. Where little or nothing was counted, it is close
/// to 1 and its standard error close to 0.5.
struct Crossings {
  double radius = 0;    ///< of spheres that 3 in 1000 uniform segments cross, or a hundredth of uniform lines
  CountedRatio around;  ///< rays that cross these
  CountedRatio near;    ///< rays that cross small spheres, over those; 1 for lines, which nothing stops
  CountedRatio discs;   ///< share of the rays through a small sphere that cross its disc in the tangent plane
};

/// Counts some of the rays (EvidenceEffort), or half of these if they show for each value whether it passes its threshold, to two standard errors.
/// Looks at 4096 discs, or at 512 if the rays are lines. The small spheres are crossed by 3 in 10 000 uniform segments;
/// for lines they are as large as the others. They are not smaller than discs. Throws Stopped if a stop was requested.
[[nodiscard]] Crossings count_crossings(const EffectSample& sample);

}  // namespace detp::sim
