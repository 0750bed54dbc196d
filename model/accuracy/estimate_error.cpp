#include "estimate_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace detp::model {
namespace {

constexpr long double pi = std::numbers::pi_v<long double>;

void check(const SmoothDensity& density) {
  require_positive("density", density.value);
  require_finite("Laplacian of the density", density.laplacian);
}

void require_curvature(const SmoothDensity& density) {
  check(density);
  if (density.laplacian == 0)
    throw std::invalid_argument("the Laplacian of the density must not be 0: without it no radius is best");
}

/// d/r₀, which may be below the range of doubles.
long double size_of(DiscRadius disc, SphereRadius outer) {
  require_positive("disc radius", disc.value);
  require_positive("sphere radius", outer.value);
  if (disc.value > outer.value)
    throw std::invalid_argument(
        fmt::format("disc radius must not exceed the sphere radius {} (got {})", outer.value, disc.value));
  return static_cast<long double>(disc.value) / outer.value;
}

}  // namespace

double uniform_field_deviation(double rays, DiscRadius disc, SphereRadius outer) {
  require_count("number of rays", rays, 1, 1e18);
  const long double x = size_of(disc, outer);
  return saturated(std::sqrt((2 - x * x) / rays) / x);  // (1 - p)/p = (2 - x²)/x²
}

double rays_for_deviation(double deviation, DiscRadius disc, SphereRadius outer) {
  require_positive("relative deviation", deviation);
  const long double x = size_of(disc, outer);
  return saturated((2 - x * x) / (x * deviation) / (x * deviation));
}

DensityError density_error(const SmoothDensity& density, double photons, double radius) {
  check(density);
  require_positive("number of photons", photons);
  require_positive("disc radius", radius);
  const long double area = static_cast<long double>(radius) * radius;
  return {.variance = saturated(density.value / (photons * pi * area)),
          .bias = saturated(area * density.laplacian / 8)};
}

double best_density_radius(const SmoothDensity& density, double photons) {
  require_curvature(density);
  require_positive("number of photons", photons);
  const long double ratio = 32.0L * density.value / (photons * pi);
  return saturated(std::cbrt(std::sqrt(ratio) / std::abs(density.laplacian)));
}

double photons_for_error(const SmoothDensity& density, double relative_error) {
  require_curvature(density);
  require_positive("relative error", relative_error);
  const long double f = density.value;
  const long double error = relative_error;
  const long double scale = std::sqrt(3.375L / 32) / pi;  // (3/2)^{3/2} / (√32 π)
  return saturated(scale * std::abs(density.laplacian) / (f * f) / (error * error * error));
}

}  // namespace detp::model
