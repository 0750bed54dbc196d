#include "mixed_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/geometry/turn.hpp"

namespace detp::sim {
namespace {

FieldMixture checked(FieldMixture mixture) {
  check(mixture.shares);
  for (int axis = 0; axis < 3; ++axis) {
    require_finite("direction of the parallel lines", mixture.direction[axis]);
    require_finite("point of the segments", mixture.point[axis]);
  }
  mixture.direction = unit_or_zero(mixture.direction);
  if (mixture.direction == glm::dvec3{0.0})
    throw std::invalid_argument("direction of the parallel lines must not be zero");
  return mixture;
}

}  // namespace

void check(const FieldShares& shares) {
  for (const double share : {shares.isotropic, shares.directional, shares.point})
    require_share("share of a kind of rays", share);
  const double sum = shares.isotropic + shares.directional + shares.point;
  if (std::abs(sum - 1) > 1e-9)
    throw std::invalid_argument(fmt::format("shares of the kinds of rays must add up to 1 (got {})", sum));
}

MixedField::MixedField(const FieldMixture& mixture, std::uint64_t seed, std::uint64_t count)
    : mixture_(checked(mixture)), lines_(mixture.sphere, seed), seed_(seed), count_(count) {
  const double ratio = mixture_.sphere.radius / glm::distance(mixture_.point, mixture_.sphere.centre);
  if (std::abs(ratio - 1) < 1e-9) throw std::invalid_argument("point of the segments must not lie on the sphere");
  if (ratio < 1) cap_ = ratio * ratio / (1 + std::sqrt(1 - ratio * ratio));
}

Ray MixedField::ray(std::uint64_t index) const {
  const double kind = van_der_corput(index);
  const FieldShares& shares = mixture_.shares;
  if (kind < shares.isotropic || (shares.directional == 0 && shares.point == 0)) return lines_.line(index);
  return kind < shares.isotropic + shares.directional || shares.point == 0 ? parallel(index) : from_point(index);
}

Ray MixedField::parallel(std::uint64_t index) const {
  const auto random = uniform4(seed_, Stream::line_field, index);
  const auto [first, second] = basis_around(mixture_.direction);
  const double radius = mixture_.sphere.radius * std::sqrt(random[2]);
  const Turn place = turn(random[3]);
  return {.origin = mixture_.sphere.centre + radius * (place.cos * first + place.sin * second),
          .direction = mixture_.direction};
}

Ray MixedField::from_point(std::uint64_t index) const {
  const auto random = uniform4(seed_, Stream::line_field, index);
  const glm::dvec3 to_centre = mixture_.sphere.centre - mixture_.point;
  const glm::dvec3 axis = cap_ < 2 ? unit_or_zero(to_centre) : glm::dvec3{0.0, 0.0, 1.0};
  const double below = cap_ * random[0];
  const double across = std::sqrt(below * (2 - below));
  const Turn around = turn(random[1]);
  const auto [first, second] = basis_around(axis);
  const glm::dvec3 direction =
      glm::normalize((1 - below) * axis + across * around.cos * first + across * around.sin * second);
  const double along = glm::dot(to_centre, direction);
  const glm::dvec3 aside = to_centre - along * direction;
  const double half_chord =
      std::sqrt(std::max(0.0, mixture_.sphere.radius * mixture_.sphere.radius - glm::dot(aside, aside)));
  return {.origin = mixture_.point, .direction = direction, .length = along + half_chord};
}

void MixedField::read(std::uint64_t first, std::span<Ray> block, const std::stop_token& stop) const {
  constexpr std::size_t rays_at_once = 4096;
  sim::parallel_for(ParallelRange(0, block.size(), rays_at_once), [&](const ParallelRange& range) {
    StopCheck check(stop, "making rays");
    check.now();
    for_each_checked(range.begin(), range.end(), check, [&](std::size_t i) { block[i] = ray(first + i); });
  });
}

double MixedField::farthest_from(const glm::dvec3& point) const {
  const double of_lines = LinesOfField(mixture_.sphere, seed_, count_).farthest_from(point);
  return mixture_.shares.point > 0 ? std::max(of_lines, (1 + 1e-12) * glm::distance(mixture_.point, point)) : of_lines;
}

}  // namespace detp::sim
