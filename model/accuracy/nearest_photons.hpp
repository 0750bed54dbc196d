#pragma once

#include "estimate_error.hpp"

/// Error of the density estimate from the k nearest photons (photon maps), compared with that of a disc of fixed radius
/// (estimate_error.hpp).
///
///     unbiased  (k - 1)/(nπ r_k²)        plain  k/(nπ r_k²)
///
///   where  n     photons, each landing with density f around the point, in 1/area
///          k     photons searched for, 3 … n
///          r_k   distance of the k-th nearest, length
///
/// Let x be the probability that a photon lands within r_k. It has the distribution Beta(k, n - k + 1), so
/// E[1/x] = n/(k - 1) and E[1/x²] = n(n - 1)/((k - 1)(k - 2)). If f is uniform, x = π r_k² f. This gives exactly
///
///     E[unbiased] = f       E[plain] = f k/(k - 1)       variance of unbiased = f² (1 - p)/(k - 2)
///
/// with p = (k - 1)/n. Sources: García, Ureña, Sbert, CGF 2012 (the bias); our derivation (the variance). With
/// curvature x = A(f + A ∇²f/8π), A = π r_k², so 1/A exceeds f/x by ∇²f/(8πf) for any x. To leading order, curvature
/// adds (k - 1)/n ∇²f/(8πf) to the bias of the unbiased estimate, and k/n ∇²f/(8πf) to that of the plain estimate.
///
/// A disc that expects the same number of photons, k = nπh²f, has variance f²/k and bias k∇²f/(8πnf). The unbiased
/// estimate has k/(k - 2) times this variance and (k - 1)/k times this bias. The best mean square errors of both agree
/// to leading order, f² 3/(2k). But r_k adapts to f, while the disc's radius is fixed.
///
/// Validity   density uniform around the point up to r_k, except for its curvature: k∇²f/(8πnf²) far below 1, no edge
///            of the surface within r_k. n is fixed; for a Poisson number of photons p = 0.
/// Counted    in tests/model/accuracy/nearest_photons.test.cpp. Uniform density, k = 10, 30, 100: variances within
///            1.5 %, standard errors 0.8 to 1.3 %. Parabolic density, k = 200 of 2000, ten times the test's replicates:
///            bias 1.5 % off, standard error 1.3 % (the next order is 2 %); variance 1.3 % off, standard error 0.6 %.
namespace detp::model {

/// Variance and bias of the unbiased estimate. Throws std::invalid_argument unless f > 0, n and k are whole numbers,
/// 3 <= k <= n <= 1e18.
[[nodiscard]] DensityError nearest_photons_error(const SmoothDensity& density, double photons, double nearest);

/// Variance and bias of the plain estimate, which is k/(k - 1) times the unbiased estimate. So its standard deviation
/// is k/(k - 1) times as large, and its bias is k/(k - 1) times that of the unbiased estimate, plus f/(k - 1).
[[nodiscard]] DensityError plain_nearest_photons_error(const SmoothDensity& density, double photons, double nearest);

/// The whole number k, 3 … n, with the smallest mean square error of the unbiased estimate; n if ∇²f = 0. The
/// derivative of the error, with (1 - p)/(k - 2) = (1 - 1/n)/(k - 2) - 1/n, is 0 at the root of
///
///     (k - 1)(k - 2)² = (1 - 1/n) 32π² n² f⁴/(∇²f)²
///
/// and k is next to this root. Throws std::invalid_argument as nearest_photons_error does.
[[nodiscard]] double best_nearest_photons(const SmoothDensity& density, double photons);

/// n for a relative root mean square error ε at the best k. n and k are not rounded; p is neglected:
///
///     n = |∇²f| y √(2(y + 1))/(8π f²)       y = k - 2 = (3 + √(9 + 8ε²))/(4ε²)
///
/// Limits     ε → 0: (1 + 2ε²/3) times the n of the disc at its best radius (photons_for_error).
/// Throws     std::invalid_argument unless f and ε are > 0, ∇²f is not 0, and all are finite.
[[nodiscard]] double photons_for_nearest_error(const SmoothDensity& density, double relative_error);

}  // namespace detp::model
