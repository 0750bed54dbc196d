#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

/// How accurate an irradiance estimate is, and how more rays or another radius would change its error.
///
/// Accuracy: relative error at most 1.1e-16 (3.3e-16 for the mean square error) compared with 100 digits, over 10⁶
/// inputs log-uniform over all doubles (tests/model/hard_cases). Results above the largest double saturate; below the
/// smallest normal double the error is at most one spacing of doubles.
namespace detp::model {

/// Relative standard deviation of one disc's irradiance in a uniform field of lines.
///
///     σ = √((1 - p)/(n_R p))      p = d²/(2r₀²)
///
///   where  n_R   rays, all of one power;   d, r₀   radii of disc and S₀, length
///
/// The number of hits of a disc is binomial. Source: our derivation, compared with counts in
/// tests/model/accuracy/estimate_error.test.cpp. Throws std::invalid_argument unless n_R is a count and 0 < d <= r₀.
[[nodiscard]] double uniform_field_deviation(double rays, DiscRadius disc, SphereRadius outer);

/// n_R = (1 - p)/(p σ²): the number of rays at which uniform_field_deviation is σ > 0. Not rounded to a whole number.
/// Throws std::invalid_argument unless σ > 0, finite, and 0 < d <= r₀.
[[nodiscard]] double rays_for_deviation(double deviation, DiscRadius disc, SphereRadius outer);

/// A density of photons on a surface around a point: each of n photons lands with density f, in 1/area.
struct SmoothDensity {
  double value = 0;      ///< f > 0, 1/area
  double laplacian = 0;  ///< ∇²f, 1/area²
};

/// Error of the disc estimate of a smooth density, with n photons and radius h.
///
///     variance = f/(nπh²)      bias = h² ∇²f/8      MSE = variance + bias²
///
/// Leading order: h must be far below the distance over which f changes, and nπh²f far above 1.
struct DensityError {
  double variance = 0;  ///< 1/area²
  double bias = 0;      ///< 1/area, with its sign

  [[nodiscard]] double mean_square() const { return saturated(variance + static_cast<long double>(bias) * bias); }
};

/// Variance and bias for n photons and radius h. Source: our derivation, by Taylor expansion of f over the disc,
/// compared with counts in tests/model/accuracy/estimate_error.test.cpp. Throws std::invalid_argument unless n, f and h
/// are > 0 and all numbers are finite.
[[nodiscard]] DensityError density_error(const SmoothDensity& density, double photons, double radius);

/// h with h⁶ = 32 f/(nπ(∇²f)²): the radius with the smallest mean square error, which is proportional to
/// n^{-2/3}. Throws std::invalid_argument as density_error does, and for ∇²f = 0: without curvature a larger disc is
/// always better.
[[nodiscard]] double best_density_radius(const SmoothDensity& density, double photons);

/// n for a relative root mean square error ε at the best radius: n = (3/2)^{3/2} |∇²f| / (√32 π f² ε³).
/// Throws std::invalid_argument unless f, ε > 0, ∇²f is not 0, and all are finite.
[[nodiscard]] double photons_for_error(const SmoothDensity& density, double relative_error);

}  // namespace detp::model
