#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

/// Errors of irradiance over a scene: root mean squares over points spread by area, relative to the root mean square
/// irradiance B. Noise falls with the number of photons, bias does not.
///
/// Let all photons carry the same power φ (the flux of the lights over the number of photons), and let E be the irradiance.
///
/// Accuracy   relative error at most 1e-15, compared with 100 digits (tests/model/hard_cases)
/// Counted    on @furnace, a closed box, by the claims `accuracy.*` of `detp validate`
namespace detp::model {

/// The light on the surfaces of a scene.
struct SceneLight {
  double mean = 1;         ///< of E over the area, > 0
  double mean_square = 1;  ///< of E² over the area: B²; at least mean²
};

/// noise² of discs:
///
///     noise² = c φ ⟨E⟩/(π d² B²)
///
///   where  φ   power of one photon;   d   radius, length;   ⟨E⟩, B²   mean of E and of E²
///          c   clumping: Σ m²/Σ m over photons, m the number of pieces of one path that cross the same disc; >= 1
///
/// A disc with irradiance E expects π d² E/φ crossings. If they come in clumps of m, the variance of their number is c times that of
/// independent ones. With c = 1, pieces would be independent. Source: our derivation. Throws std::invalid_argument unless φ and d are
/// > 0, c >= 1 and all are finite.
[[nodiscard]] double disc_noise_squared(const SceneLight& light, double photon_power, double radius,
                                        double clumping = 1);

/// Clumping in a closed diffuse room of n flat walls that all see each other alike, as a cube:
///
///     c = 1 + 2 q (ρ/(1 - ρ) - ρ/(1 + ρ/(n - 1))),   q = π d²/A
///
///   where  ρ   probability that a wall reflects a photon, 0 … below 1;   A   area of all walls;   q   at most 1
///
/// The next piece from a wall ends on one of the others: the probability that piece j after a crossing ends on the same wall
/// obeys p_1 = 0, p_{j+1} = (1 - p_j)/(n - 1), so p_j = (1 - (-1/(n - 1))^{j-1})/n, and it then crosses the disc with probability n q. The sum
/// of ρ^j p_j n q over j counts once the later pieces, and once the earlier ones.
///
/// Counted  on @furnace (ρ = 1/2, d = 0.25, discs in the middle of the walls): c - 1 = 0.0398 ± 0.0005 where 0.0357 is predicted;
///          paths that come back are more often near the middle.
/// Source   our derivation. Throws std::invalid_argument for arguments out of range, n from 2 to 1e18.
[[nodiscard]] double room_clumping(double reflected, double radius, double area, double walls);

/// noise² of triangle hits on a mesh of triangles of equal area, six around each vertex:
///
///     noise² = c φ ⟨E⟩/(9 a B²)        a   area of a triangle
///
/// A point with the weights b_i of its triangle's corners takes the photons of the 13 triangles around it, with the weights
/// w = Σ b_i/(6a) over the shared corners. The mean of Σ w² a over the triangle is (1 + 3/2 + 3/2)/(36 a): of the triangle itself, of
/// three that share an edge, and of nine that share one corner. So these hits have the noise of discs of area 9a. Source: our
/// derivation. Throws as disc_noise_squared.
[[nodiscard]] double triangle_noise_squared(const SceneLight& light, double photon_power, double triangle_area,
                                            double clumping = 1);

/// bias² of discs of radius d:
///
///     bias² = c₀ + c₁ d + c₄ d⁴
///
/// c₀: samples on edges, whose discs lose a share of their light whatever their radius. c₁: discs that reach beyond an edge. c₄: smooth
/// irradiance that is not linear.
struct BiasTerms {
  double constant = 0;  ///< c₀ >= 0
  double linear = 0;    ///< c₁ >= 0, 1/length
  double fourth = 0;    ///< c₄ >= 0, 1/length⁴
};

/// Throws std::invalid_argument unless d is > 0 and all terms are finite and >= 0.
[[nodiscard]] double bias_squared(const BiasTerms& terms, double radius);

/// c₀ of samples on straight edges beyond which there is no light: the disc loses half. A share s of the samples on edges with the
/// irradiance of the others gives c₀ = s/4. Throws std::invalid_argument unless 0 <= s <= 1.
[[nodiscard]] double bias_of_samples_on_edges(double share);

/// c₁ of surfaces of area A with edges of length L, each counted for each face that ends there:
///
///     c₁ = I L/A,   I = ∫₀¹ q(t)² dt = (2π/3 - 64/45)/π² = 0.068105
///
///   where  q(t) = (arccos t - t √(1 - t²))/π   share of a disc beyond an edge at the distance t d from its centre
///
/// Valid    for straight edges longer than d, faces wider than 2d, no light beyond the edge, and even light (⟨E²⟩ at edges as
///          elsewhere). In corners of rooms where paths go on through walls (sim/effects), less is lost.
/// Source   our derivation. Throws std::invalid_argument unless L >= 0 and A > 0 are finite.
[[nodiscard]] double bias_of_edges(double edges, double area);

/// c₄ = ⟨(∇²E)²⟩/(64 B²), of the bias d² ∇²E/8 (estimate_error.hpp). Counted in parallel light with E = 1 + 2 r², d = 0.4: -0.01 %
/// (standard error 0.02 %). Throws std::invalid_argument unless the mean square of the
/// Laplacian is >= 0 and finite, and as disc_noise_squared.
[[nodiscard]] double bias_of_curvature(const SceneLight& light, double mean_square_laplacian);

}  // namespace detp::model
