#include "line_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"

namespace detp::sim {

LineField::LineField(const Sphere& sphere, std::uint64_t seed) : sphere_(sphere), seed_(seed) {
  require_positive("sphere radius", sphere.radius);
  for (int axis = 0; axis < 3; ++axis) require_finite("sphere centre", sphere.centre[axis]);
  const double farthest =
      std::max({sphere.radius, std::abs(sphere.centre.x), std::abs(sphere.centre.y), std::abs(sphere.centre.z)});
  if (farthest > largest_coordinate)
    throw std::invalid_argument(fmt::format("sphere centre and radius must be within 1e100 (got {})", farthest));
}

Ray line_at(const Sphere& sphere, const std::array<double, 4>& coordinates) {
  const auto& [u, v, w, phi] = coordinates;
  const glm::dvec3 direction = uniform_direction(u, v);
  const auto [first, second] = basis_around(direction);
  const double radius = sphere.radius * std::sqrt(w);
  const double angle = 2.0 * std::numbers::pi * phi;
  return {.origin = sphere.centre + radius * (std::cos(angle) * first + std::sin(angle) * second),
          .direction = direction};
}

Ray LineField::line(std::uint64_t index) const { return line_at(sphere_, uniform4(seed_, Stream::line_field, index)); }

std::vector<Ray> LineField::lines(std::uint64_t first, std::size_t count, const std::stop_token& stop) const {
  const DefaultFloatingPoint mode;
  StopCheck check(stop, "making lines");
  std::vector<Ray> rays;
  rays.reserve(count);
  for_each_checked(0, count, check, [&](std::size_t i) { rays.push_back(line(first + i)); });
  return rays;
}

}  // namespace detp::sim
