#include "line_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/geometry/turn.hpp"
#include "line_vectors.hpp"

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
  const Turn place = turn(phi);
  return {.origin = sphere.centre + radius * (place.cos * first + place.sin * second), .direction = direction};
}

Ray LineField::line(std::uint64_t index) const { return line_at(sphere_, uniform4(seed_, Stream::line_field, index)); }

void LineField::write(std::uint64_t first, std::span<Ray> lines, const std::stop_token& stop) const {
  StopCheck check(stop, "making lines");
  check.now();
  LineCoordinates coordinates;
  while (!lines.empty()) {
    const std::size_t count = std::min(lines.size(), LineCoordinates::most);
    check.after(count);
    auto& [u, v, w, phi] = coordinates.of;
    uniform4(seed_, Stream::line_field, first, count, {u.data(), v.data(), w.data(), phi.data()});
    write_lines(sphere_, coordinates, lines.first(count));
    lines = lines.subspan(count);
    first += count;
  }
}

std::vector<Ray> LineField::lines(std::uint64_t first, std::size_t count, const std::stop_token& stop) const {
  const DefaultFloatingPoint mode;
  std::vector<Ray> rays(count);
  write(first, rays, stop);
  return rays;
}

}  // namespace detp::sim
