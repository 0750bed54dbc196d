#include "directions.hpp"

#include <algorithm>
#include <cmath>

#include "turn.hpp"

namespace detp::sim {

std::array<glm::dvec3, 2> basis_around(const glm::dvec3& axis) {
  const double sign = std::copysign(1.0, axis.z);
  const double a = -1.0 / (sign + axis.z);
  const double b = axis.x * axis.y * a;
  return {glm::dvec3{1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x},
          glm::dvec3{b, sign + axis.y * axis.y * a, -axis.y}};
}

glm::dvec3 uniform_direction(double u, double v) {
  const double z = 1.0 - 2.0 * u;
  const double rho = std::sqrt(std::max(0.0, 1.0 - z * z));
  const Turn around = turn(v);
  return {rho * around.cos, rho * around.sin, z};
}

glm::dvec3 cosine_direction(const glm::dvec3& axis, double u, double v) {
  const double rho = std::sqrt(u);
  const Turn around = turn(v);
  const auto [first, second] = basis_around(axis);
  return rho * around.cos * first + rho * around.sin * second + std::sqrt(1.0 - u) * axis;
}

}  // namespace detp::sim
