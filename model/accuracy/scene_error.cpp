#include "scene_error.hpp"

#include <fmt/format.h>

#include <numbers>
#include <stdexcept>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/model/vocabulary/saturated.hpp"

namespace detp::model {
namespace {

using std::numbers::pi_v;
using Long = long double;

void require_light(const SceneLight& light) {
  require_positive("mean irradiance", light.mean);
  require_positive("mean square irradiance", light.mean_square);
}

/// c φ ⟨E⟩/(area B²).
double noise_squared(const SceneLight& light, double photon_power, double clumping, Long area) {
  require_light(light);
  require_positive("power of a photon", photon_power);
  require_finite("clumping", clumping);
  if (clumping < 1) throw std::invalid_argument(fmt::format("clumping must be at least 1 (got {})", clumping));
  return saturated(Long{clumping} * photon_power * light.mean / (area * light.mean_square));
}

}  // namespace

double disc_noise_squared(const SceneLight& light, double photon_power, double radius, double clumping) {
  require_positive("disc radius", radius);
  return noise_squared(light, photon_power, clumping, pi_v<Long> * radius * radius);
}

double triangle_noise_squared(const SceneLight& light, double photon_power, double triangle_area, double clumping) {
  require_positive("area of a triangle", triangle_area);
  return noise_squared(light, photon_power, clumping, Long{9} * triangle_area);
}

double room_clumping(double reflected, double radius, double area, double walls) {
  require_positive("disc radius", radius);
  require_positive("area of the room", area);
  require_non_negative("probability of reflection", reflected);
  require_count("number of walls", walls, 2, 1e18);
  if (reflected >= 1)
    throw std::invalid_argument(fmt::format("probability of reflection must be below 1 (got {})", reflected));
  const Long share = pi_v<Long> * radius * radius / area;
  if (share > 1)
    throw std::invalid_argument(fmt::format("a disc of radius {} is larger than the room of area {}", radius, area));
  const Long rho = reflected;
  // ρ/(1 - ρ) - ρ/(1 + ρ/(n - 1)) without cancellation
  const Long others = walls - 1;
  const Long later = rho * rho * (1 + others) / ((1 - rho) * (others + rho));
  return saturated(1 + 2 * share * later);
}

double bias_squared(const BiasTerms& terms, double radius) {
  require_positive("disc radius", radius);
  require_non_negative("constant term of the bias", terms.constant);
  require_non_negative("linear term of the bias", terms.linear);
  require_non_negative("fourth-order term of the bias", terms.fourth);
  const Long square = Long{radius} * radius;
  return saturated(terms.constant + Long{terms.linear} * radius + terms.fourth * square * square);
}

double bias_of_samples_on_edges(double share) {
  require_share("share of samples on edges", share);
  return 0.25 * share;
}

double bias_of_edges(double edges, double area) {
  require_non_negative("length of edges", edges);
  require_positive("area of surfaces", area);
  constexpr Long pi = pi_v<Long>;
  constexpr Long integral = (2 * pi / 3 - Long{64} / 45) / (pi * pi);
  return saturated(integral * edges / area);
}

double bias_of_curvature(const SceneLight& light, double mean_square_laplacian) {
  require_light(light);
  require_non_negative("mean square Laplacian", mean_square_laplacian);
  return saturated(Long{mean_square_laplacian} / 64 / light.mean_square);
}

}  // namespace detp::model
