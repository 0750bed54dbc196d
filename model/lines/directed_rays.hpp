#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

/// What rays that are not isotropic hit: parallel lines, and segments from a point. Together with lines of the measure μ_ℓ
/// (line_measure.hpp) they make mixtures: the probability of a mixture is the mean of those of its kinds, weighted by
/// their shares.
namespace detp::model {

/// Probability that one of the parallel lines through a sphere crosses a disc inside it.
///
///     P = d² |cos θ| / r₀²
///
///   where  d    disc radius, length
///          r₀   sphere radius, length; the disc lies inside the sphere
///          θ    angle between the lines and the disc's normal
///
/// The lines are uniform over the disc of radius r₀ in which the sphere appears; the disc appears as an ellipse of area
/// πd² |cos θ|. The mean of |cos θ| over isotropic normals is ½, which gives disc_hit_probability.
///
/// Source     our derivation.
/// Throws     std::invalid_argument unless 0 < d <= r₀, both finite, and -1 <= cos θ <= 1.
[[nodiscard]] double parallel_disc_hit_probability(DiscRadius disc, SphereRadius outer, double cosine);

/// A point as seen from a disc.
struct PointOverDisc {
  double height = 0;  ///< distance from the disc's plane, length >= 0
  double offset = 0;  ///< distance from the disc's axis, length >= 0
};

/// Solid angle of a disc, seen from a point, in steradians.
///
///     Ω = 2π - 2h/R K(k) - π Λ₀(ξ, k)    for ρ < d
///     Ω =  π - 2h/R K(k)                  for ρ = d
///     Ω =    - 2h/R K(k) + π Λ₀(ξ, k)    for ρ > d
///
///   where  h, ρ   height and offset of the point;   d   disc radius;   R² = h² + (ρ + d)²
///          k² = 4ρd/R²,  ξ = atan(h / |ρ - d|)
///          K      complete elliptic integral of the first kind;   Λ₀   Heuman's lambda function
///
/// From s = √(h² + ρ²) > 300 d, where the terms cancel, the first two terms of the series in (d/s)²:
///
///     Ω = πd² h/s³ (1 + (d²/8)(15ρ²/s⁴ - 6/s²))
///
/// Source     F. Paxton, Solid Angle Calculation for a Circular Disk, Review of Scientific Instruments 30(4), 1959; the
///            series: our derivation.
/// Limits     h → 0: 2π for ρ < d, 0 for ρ > d.   h → ∞: πd²/h².
/// Accuracy   1e-9 relative, where Ω exceeds 1e-30 and h > 1e-6 d.
/// Throws     std::invalid_argument unless d > 0, h, ρ >= 0, all finite.
[[nodiscard]] double disc_solid_angle(DiscRadius disc, const PointOverDisc& point);

/// Solid angle of a sphere, seen from a point at a distance from its centre, in steradians: 4π from inside, else
/// 2π (1 - √(1 - r²/D²)).
///
/// Source     elementary. Throws std::invalid_argument unless r > 0, D >= 0, both finite.
[[nodiscard]] double sphere_solid_angle(SphereRadius sphere, double distance);

/// Probability that a ray from a point hits a disc inside a sphere, if its direction is uniform over those that meet the
/// sphere: the disc's solid angle over the sphere's.
///
///   where  distance   of the point from the sphere's centre, length
///
/// Source     our derivation. Valid where the disc lies inside the sphere. Throws as the two solid angles.
[[nodiscard]] double point_disc_hit_probability(DiscRadius disc, const PointOverDisc& point, SphereRadius outer,
                                                double distance);

}  // namespace detp::model
