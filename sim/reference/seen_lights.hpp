#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "detp/sim/scene/scene.hpp"

namespace detp::sim {

/// Light below this cosine is none: surfaces in the same plane see each other by rounding errors alone.
inline constexpr double least_cosine = 1e-12;

/// Light that reaches a point straight from a light, unless something is in between.
struct SeenLight {
  glm::dvec3 direction{0.0};  ///< unit length, from the point to the light
  double distance = 0;        ///< in scene units; unbounded for parallel light
  /// On a surface across the direction: its expectation over the random numbers is the irradiance of all lights but the environment.
  double irradiance = 0;
  /// Probability of the direction, per solid angle; 0 if the light has no extent: a path never meets it.
  double density = 0;
  std::optional<std::uint32_t> triangle = {};  ///< of a surface light
};

/// A scene's lights as a point sees them: what photons bring to it from the emitters (emitter.hpp), looked at from the other end.
/// Fluxes become radiances and intensities:
///
///     point Φ/4π   spot Φ/(2π(1 - cos α))   area Φ/(π A)   directional Φ/(π R²)   environment Φ/(4π² R²)
///
///   where  R   radius of the sphere around the scene's box from which these photons start;  α   half angle;  A   area
///
/// A surface light's triangles have their own radiances.
class SeenLights {
 public:
  /// The scene must outlive this. Its lights and materials must be valid (Lights).
  explicit SeenLights(const Scene& scene);

  /// One light, chosen by its flux, and a point of it, determined by four uniform numbers in [0, 1).
  [[nodiscard]] SeenLight sample(const glm::dvec3& point, const std::array<double, 4>& random) const;

  /// A ray that looks for lights. Lights with extent are also found by `sample`. Both find a share of their light:
  /// density/(density + that of sample), the balance heuristic (E. Veach, L. Guibas, SIGGRAPH 1995).
  struct Look {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0};
    double density =
        unbounded;  ///< probability of the direction, per solid angle; unbounded if `sample` was not called
  };

  /// The look's share of the radiance of the area lights that it crosses from their front before `distance`.
  [[nodiscard]] double radiance_on_the_way(const Look& look, double distance) const;
  /// The look's share of the radiance of a triangle that it meets at `distance`; 0 from a side that
  /// does not emit, or without a surface light.
  [[nodiscard]] double radiance_of(std::uint32_t triangle, const Look& look, double distance) const;
  /// Radiance from where nothing is.
  [[nodiscard]] double environment() const { return environment_; }

 private:
  struct Source {
    const Light* light;
    double up_to;  ///< sum of the probabilities up to and including this light
    double probability;
    double strength;  ///< radiance or intensity; of directional light, irradiance
  };
  struct Emitting {
    std::uint32_t triangle;
    double up_to;  ///< sum of the fluxes up to and including this one
    double area;
    glm::dvec3 normal;  ///< of the side that emits
    double radiance;
  };

  [[nodiscard]] double surface_density(double radiance, double distance, double cosine) const;
  [[nodiscard]] SeenLight seen(const PointLight& light, double strength, const glm::dvec3& point, double u,
                               double v) const;
  [[nodiscard]] SeenLight seen(const SpotLight& light, double strength, const glm::dvec3& point, double u,
                               double v) const;
  [[nodiscard]] SeenLight seen(const AreaLight& light, double strength, const glm::dvec3& point, double u,
                               double v) const;
  [[nodiscard]] SeenLight seen(const DirectionalLight& light, double strength, const glm::dvec3& point, double u,
                               double v) const;
  [[nodiscard]] SeenLight seen(const SurfaceLight& light, double strength, const glm::dvec3& point, double u,
                               double v) const;
  [[nodiscard]] SeenLight seen(const EnvironmentLight&, double, const glm::dvec3&, double, double) const { return {}; }

  const Scene& scene_;
  std::vector<Source> sources_;
  std::vector<Emitting> emitting_;
  double environment_ = 0;
  /// Probability that `sample` chooses the surface light, over the flux of its triangles; 0 without one.
  double surface_density_ = 0;
  double surface_scale_ = 0;  ///< flux of the surface light over the flux that its triangles' radiances make
};

}  // namespace detp::sim
