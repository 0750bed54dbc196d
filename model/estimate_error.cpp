#include "estimate_error.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "line_measure.hpp"

namespace detp::model {
namespace {

using std::numbers::pi;

void check(const SmoothDensity& density) {
  require_positive("density", density.value);
  require_finite("Laplacian of the density", density.laplacian);
}

void require_curvature(const SmoothDensity& density) {
  check(density);
  if (density.laplacian == 0)
    throw std::invalid_argument("the Laplacian of the density must not be 0: without it no radius is best");
}

}  // namespace

double uniform_field_deviation(double rays, DiscRadius disc, SphereRadius outer) {
  require_count("number of rays", rays, 1, 1e18);
  const double p = disc_hit_probability(disc, outer);
  return std::sqrt((1 - p) / rays / p);
}

double rays_for_deviation(double deviation, DiscRadius disc, SphereRadius outer) {
  require_positive("relative deviation", deviation);
  const double p = disc_hit_probability(disc, outer);
  return (1 - p) / p / deviation / deviation;
}

DensityError density_error(const SmoothDensity& density, double photons, double radius) {
  check(density);
  require_positive("number of photons", photons);
  require_positive("disc radius", radius);
  return {.variance = density.value / (photons * pi * radius * radius),
          .bias = radius * radius * density.laplacian / 8};
}

double best_density_radius(const SmoothDensity& density, double photons) {
  require_curvature(density);
  require_positive("number of photons", photons);
  const double ratio = 32 * density.value / (photons * pi);
  return std::cbrt(std::sqrt(ratio) / std::abs(density.laplacian));
}

double photons_for_error(const SmoothDensity& density, double relative_error) {
  require_curvature(density);
  require_positive("relative error", relative_error);
  const double scale = std::pow(1.5, 1.5) / (std::sqrt(32.0) * pi);
  return scale * (std::abs(density.laplacian) / density.value) / density.value / std::pow(relative_error, 3);
}

}  // namespace detp::model
