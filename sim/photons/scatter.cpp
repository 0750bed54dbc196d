#include "scatter.hpp"

#include <algorithm>
#include <cmath>

#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/turn.hpp"

namespace detp::sim {
namespace {

/// cos of the angle behind the boundary, 0 beyond the critical angle.
double refracted_cosine(double cosine, double index) {
  return std::sqrt(std::max(0.0, 1 - (1 - cosine * cosine) / (index * index)));
}

glm::dvec3 mirrored(const glm::dvec3& incoming, const glm::dvec3& side) {
  return glm::normalize(incoming - 2 * glm::dot(incoming, side) * side);
}

glm::dvec3 glossy(double shininess, const glm::dvec3& side, const glm::dvec3& incoming, double u, double v) {
  const glm::dvec3 mirror = mirrored(incoming, side);
  if (std::isinf(shininess)) return mirror;
  const double step = std::sqrt(-2 * std::log1p(-u) / shininess);
  const Turn around = turn(v);
  const auto [first, second] = basis_around(side);
  const glm::dvec3 flat =
      mirror - glm::dot(mirror, side) * side + step * around.cos * first + step * around.sin * second;
  const double height = 1 - glm::dot(flat, flat);
  return height > 0 ? glm::normalize(flat + std::sqrt(height) * side) : mirror;
}

/// `side`: the normal that points to where the photon comes from.
glm::dvec3 through_glass(double index, const glm::dvec3& side, const glm::dvec3& incoming, double random) {
  const double cosine = std::clamp(-glm::dot(incoming, side), 1e-12, 1.0);
  if (random < fresnel_reflectance(cosine, index)) return mirrored(incoming, side);
  const glm::dvec3 along = (incoming + cosine * side) / index;
  return glm::normalize(along - refracted_cosine(cosine, index) * side);
}

}  // namespace

double fresnel_reflectance(double cosine, double index) {
  const double behind = refracted_cosine(cosine, index);
  if (behind == 0) return 1;
  const double across = (cosine - index * behind) / (cosine + index * behind);
  const double along = (index * cosine - behind) / (index * cosine + behind);
  return 0.5 * (across * across + along * along);
}

std::optional<glm::dvec3> scattered(const Material& material, const glm::dvec3& normal, const glm::dvec3& incoming,
                                    const std::array<double, 4>& random) {
  const auto next =
      scattered_by(material, {material.diffuse, material.specular, material.glass}, normal, incoming, random);
  return next ? std::optional(next->direction) : std::nullopt;
}

std::optional<Scattered> scattered_by(const Material& material, const Shares& shares, const glm::dvec3& normal,
                                      const glm::dvec3& incoming, const std::array<double, 4>& random) {
  const bool on_front = glm::dot(normal, incoming) < 0;
  const glm::dvec3 side = on_front ? normal : -normal;
  double rest = random[0];
  if (rest < shares.diffuse) return Scattered{cosine_direction(side, random[1], random[2]), ScatteredBy::diffuse};
  rest -= shares.diffuse;
  if (rest < shares.specular)
    return Scattered{glossy(material.shininess, side, incoming, random[1], random[2]), ScatteredBy::specular};
  rest -= shares.specular;
  if (rest < shares.glass)
    return Scattered{through_glass(on_front ? material.index : 1 / material.index, side, incoming, random[3]),
                     ScatteredBy::glass};
  return std::nullopt;
}

}  // namespace detp::sim
