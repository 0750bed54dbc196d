#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

/// What a uniform, isotropic random line hits.
///
/// Every expected count here follows from one fact of integral geometry: lines with the measure μ_ℓ, which is invariant
/// under rotation and translation, meet a convex body in proportion to its surface area. So P(hit inner | hit outer) is
/// a ratio of areas for any position, as long as the inner body lies inside the outer one. Otherwise the ratio is an
/// upper bound, and `both_hit_share` gives the correction.
///
/// Accuracies are the largest relative errors compared with 100 digits, over 10⁶ inputs log-uniform over the domain:
/// lengths over all doubles, workloads over all that check(workload) accepts (tests/model/hard_cases). Below the
/// smallest normal double, the error is at most one spacing of doubles.
namespace detp::model {

/// Probability that a line through a sphere also crosses a smaller sphere inside it.
///
///     P = r₁² / r₀²
///
///   where  r₁   radius of the inner sphere, length
///          r₀   radius of the outer sphere, length
///
/// Source     the paper's eq (3); Santaló, Integral Geometry, III.14.2.
/// Valid      the inner sphere lies inside the outer one. Accuracy: 3.3e-16.
/// Throws     std::invalid_argument unless 0 < r₁ <= r₀, both finite.
[[nodiscard]] double sphere_hit_probability(SphereRadius inner, SphereRadius outer);

/// Probability that a line through a sphere crosses a disc inside it.
///
///     P = d² / (2 r₀²)
///
///   where  d    disc radius, length
///          r₀   sphere radius, length; the disc lies inside the sphere
///
/// A disc is a convex body with two faces, F = 2πd², half the surface of a sphere of the same radius: hence the 2.
///
/// Source     Santaló, III.14.2; the paper's eq (3), for a disc: our derivation.
/// Valid      any position and orientation inside the sphere.
/// Limits     d → 0: 0.  d = r₀: ½.   Accuracy: 5.2e-16.
/// Throws     std::invalid_argument unless 0 < d <= r₀, both finite.
[[nodiscard]] double disc_hit_probability(DiscRadius disc, SphereRadius outer);

/// Probability that a ray of the workload crosses a convex body inside S₀.
///
///     lines      P = F / (4π r₀²)
///     segments   P = min(1, (V + ℓF/4) / V_box)
///
///   where  V, F    volume and surface area of the body
///          V_box   volume of the samples' box grown by d on all sides;   ℓ   mean length of the rays inside this box
///
/// Source     eq (3); for segments our derivation: a segment with uniform origin meets a body if its origin lies in the
///            body or if it enters through the body's surface, where the flux of segments is ℓ/(4 V_box) per area.
/// Valid      segments: origins uniform in the box, isotropic directions. If the rays are denser around the samples than
///            elsewhere, P is at_density(P, Workload::ray_density).
/// Accuracy   1.1e-16.
/// Throws     std::invalid_argument unless V, F >= 0, both finite.
[[nodiscard]] double crossing_probability(const Valid<Workload>& workload, double volume, double area);

/// The probability if rays are ρ times as dense around samples as uniform rays: ρp / (1 + (ρ - 1) p). A small probability
/// is multiplied by ρ; that of a body that all rays cross stays 1.
///
/// Source     our choice of an interpolation.
[[nodiscard]] double at_density(double probability, double density);

/// Expected (ray, disc) hits of a workload: n_R n_P P(disc), by crossing_probability of uniform rays with V = 0,
/// F = 2πd², times Workload::ray_density and Workload::hit_ratio.
///
/// Half as many if only rays that arrive at a disc's front count. (Our derivation: reversing all rays exchanges front
/// and back and does not change the isotropic measure.)
///
/// Valid      the factor ½ for fronts: isotropic directions only. Photons mostly arrive on the side of the light.
/// Accuracy   1.1e-16.
[[nodiscard]] double expected_hits(const Valid<Workload>& workload);

/// Share of the lines through sphere B that also cross sphere A, which need not contain B.
///
///     share = ∫₀¹ lens(c √(1-μ²); a, b) dμ / (π b²)
///
///   where  a, b   radii of A and B, length;   c   distance of their centres, length
///          lens   lens(x; a, b): area common to two circles of radii a, b with centres x apart, which are the spheres
///                 projected along a direction
///          μ      cosine between the direction and the line of centres, uniform in [0, 1]
///
/// Integrated by parts, with s = c√(1-μ²), p = |a-b|, q = min(c, a+b), this becomes an integral over the common chord
/// of the two circles:
///
///     c < a+b     share = min(a, b)²/b² - ∫_p^q √((c²-s²)(s²-p²)((a+b)²-s²)) ds/s / (π c b²)
///     c >= a+b    share = ∫_p^q √((q²-s²)(s²-p²)) s ds/(1 + √(1-s²/c²)) / (π c² b²)
///
/// This form loses no digits if the spheres almost touch, if one almost contains the other, or if they are far apart.
/// The integrals are evaluated by the trapezoidal rule over ln((s-p)/(q-s)), with 165 points.
///
/// Limits     B inside A (c + b <= a): 1.  A inside B: a²/b².  c → ∞: a²/(2c²).
/// Source     our derivation, from Santaló's projection formula.
/// Accuracy   4.2e-15 compared with the lenses in 100 digits (244 inputs), 5.4e-15 compared with the chords in 113 bits
///            (20 000 inputs, most of them with the spheres almost touching): largest at a + b = c. Monotone in c to
///            1e-15.
/// Throws     std::invalid_argument unless a, b > 0 and c >= 0, all finite.
[[nodiscard]] double both_hit_share(double a, double b, double c);

}  // namespace detp::model
