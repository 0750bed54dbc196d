#include "nearest_photons.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace detp::model {
namespace {

constexpr long double pi = std::numbers::pi_v<long double>;

void check(const SmoothDensity& density, double photons) {
  require_positive("density", density.value);
  require_finite("Laplacian of the density", density.laplacian);
  require_count("number of photons", photons, 3, 1e18);
}

/// y > 0 with y²(y + 1) = c. Newton's method starts above the root, where the cubic is convex, so it stays above.
long double root_of_cubic(long double c) {
  long double y = std::cbrt(c);
  for (;;) {
    const long double next = y - (y * y * (y + 1) - c) / (y * (3 * y + 2));
    if (!(next < y)) return y;
    y = next;
  }
}

}  // namespace

DensityError nearest_photons_error(const SmoothDensity& density, double photons, double nearest) {
  check(density, photons);
  require_count("photons looked for", nearest, 3, photons);
  const long double n = photons;
  const long double k = nearest;
  const long double f = density.value;
  return {.variance = saturated(f * f * (n - k + 1) / n / (k - 2)),
          .bias = saturated((k - 1) / (8 * pi * n) * (density.laplacian / f))};
}

DensityError plain_nearest_photons_error(const SmoothDensity& density, double photons, double nearest) {
  const DensityError unbiased = nearest_photons_error(density, photons, nearest);
  const long double wider = 1 + 1 / (static_cast<long double>(nearest) - 1);
  return {.variance = saturated(unbiased.variance * wider * wider),
          .bias = saturated(unbiased.bias * wider + density.value * (wider - 1))};
}

double best_nearest_photons(const SmoothDensity& density, double photons) {
  check(density, photons);
  if (density.laplacian == 0) return photons;
  const long double n = photons;
  const long double relative = std::abs(density.laplacian) / n / density.value / density.value / (8 * pi);
  const long double below = 2 + std::floor(root_of_cubic((1 - 1 / n) / (2 * relative * relative)));
  if (below >= n) return photons;
  const long double k = std::max(3.0L, below);
  const auto error = [&](long double tried) { return (1 - 1 / n) / (tried - 2) + std::pow(relative * (tried - 1), 2); };
  return static_cast<double>(error(k) <= error(k + 1) ? k : k + 1);
}

double photons_for_nearest_error(const SmoothDensity& density, double relative_error) {
  require_positive("density", density.value);
  require_finite("Laplacian of the density", density.laplacian);
  require_positive("relative error", relative_error);
  if (density.laplacian == 0)
    throw std::invalid_argument("the Laplacian of the density must not be 0: without it no k is best");
  const long double f = density.value;
  const long double square = static_cast<long double>(relative_error) * relative_error;
  const long double y = (3 + std::sqrt(9 + 8 * square)) / (4 * square);
  return saturated(std::abs(density.laplacian) / (f * f) * y * std::sqrt(2 * (y + 1)) / (8 * pi));
}

}  // namespace detp::model
