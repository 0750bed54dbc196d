#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/geometry.hpp"

/// Makes small problems from a fuzzer's bytes. Degenerate problems are likely: most bytes select special cases.
namespace detp::fuzz {

struct SmallProblem {
  std::vector<sim::Disc> discs;
  std::vector<sim::Ray> rays;
  bool front_facing = false;
};

class ProblemMaker {
 public:
  explicit ProblemMaker(FuzzedDataProvider& bytes) : bytes_(bytes) {
    scale_ = bytes_.PickValueInArray({1.0, 1.0, 1.0, 1e-9, 1e9, 1e-90, 1e-100, 1e90, 3.7});
    const double far = bytes_.PickValueInArray({0.0, 0.0, 0.0, 1.0, 1e3, 1e6, 1e12, 1e17});
    offset_ = scale_ * far * glm::dvec3{1, -0.25, 0.5};
    radius_ = scale_ * bytes_.PickValueInArray({1.0, 0.5, 0.125, 0.01, 1e-3, 1e-8, 3.0});
    one_plane_ = bytes_.ConsumeIntegralInRange(0, 7) == 0;
    one_power_ = bytes_.ConsumeBool();
  }

  SmallProblem make() {
    SmallProblem problem;
    problem.front_facing = bytes_.ConsumeIntegralInRange(0, 3) == 0;
    const int discs = bytes_.ConsumeIntegralInRange(1, 12);
    const int rays = bytes_.ConsumeIntegralInRange(1, 12);
    for (int i = 0; i < discs; ++i) problem.discs.push_back(disc(problem.discs));
    for (int i = 0; i < rays; ++i) problem.rays.push_back(ray(problem.discs));
    return problem;
  }

 private:
  bool one_in(int n) { return bytes_.ConsumeIntegralInRange(0, n - 1) == 0; }

  /// A multiple of 1/8 (a plane between cells), a value next to such a multiple, or any value from -1 to 1.
  double coordinate() {
    const double grid = bytes_.ConsumeIntegralInRange(-8, 8) / 8.0;
    switch (bytes_.ConsumeIntegralInRange(0, 4)) {
      case 0:
        return std::nextafter(grid, 2);
      case 1:
        return bytes_.ConsumeFloatingPointInRange(-1.0, 1.0);
      default:
        return grid;
    }
  }

  glm::dvec3 place() { return {coordinate(), coordinate(), one_plane_ ? 0.25 : coordinate()}; }

  glm::dvec3 direction() {
    glm::dvec3 made{0.0};
    switch (bytes_.ConsumeIntegralInRange(0, 4)) {
      case 0:
      case 1:
        made[bytes_.ConsumeIntegralInRange(0, 2)] = bytes_.ConsumeBool() ? 1 : -1;
        return made;
      case 2:
        for (int axis = 0; axis < 3; ++axis) made[axis] = bytes_.ConsumeIntegralInRange(-2, 2);
        break;
      case 3:  // almost along an axis
        made[bytes_.ConsumeIntegralInRange(0, 2)] = 1;
        made[bytes_.ConsumeIntegralInRange(0, 2)] +=
            bytes_.PickValueInArray({1e-17, -1e-9, 1e-200, 5e-324, -1e-16, 1e-3});
        break;
      default:
        for (int axis = 0; axis < 3; ++axis) made[axis] = bytes_.ConsumeFloatingPointInRange(-1.0, 1.0);
    }
    made = sim::unit_or_zero(made);
    return made == glm::dvec3{0} ? glm::dvec3{0, 0, 1} : made;
  }

  /// Returns a unit vector unchanged, rounded to floats, or scaled to another length.
  glm::dvec3 stretched(const glm::dvec3& unit) {
    if (one_in(16)) return bytes_.PickValueInArray({1e-300, 2.0, 1e200, 1 + 1e-12, 1 - 0.9e-12}) * unit;
    return one_in(8) ? glm::dvec3(glm::vec3(unit)) : unit;
  }

  sim::Disc disc(const std::vector<sim::Disc>& others) {
    sim::Disc made{offset_ + scale_ * place(), stretched(direction()), radius_};
    if (one_in(4)) made.radius = radius_ * bytes_.PickValueInArray({1e-6, 0.1, 0.5, 2.0, 10.0});
    made.radius = std::max(made.radius, 1e-100);
    if (others.empty()) return made;
    const sim::Disc& other = others[bytes_.ConsumeIntegralInRange<std::size_t>(0, others.size() - 1)];
    if (one_in(4)) made.centre = other.centre;
    if (one_in(4)) made.normal = other.normal;
    return made;
  }

  /// A point of the disc at which decisions are hard: its centre, its rim, or next to them.
  glm::dvec3 point_of(const sim::Disc& disc, const glm::dvec3& normal) {
    const auto [u, v] = sim::basis_around(normal);
    const double angle = bytes_.PickValueInArray({0.0, 1.5707963267948966, 0.7, 2.2, 3.9});
    const double share = bytes_.PickValueInArray({0.0, 1.0, 1.0, 1 - 1e-16, 1 + 1e-15, 1 - 1e-8, 1 + 1e-8, 0.5, 1.5});
    return disc.centre + share * disc.radius * (std::cos(angle) * u + std::sin(angle) * v);
  }

  sim::Ray ray(const std::vector<sim::Disc>& discs) {
    const sim::Disc& disc = discs[bytes_.ConsumeIntegralInRange<std::size_t>(0, discs.size() - 1)];
    const glm::dvec3 normal = sim::unit_or_zero(disc.normal);
    glm::dvec3 heading = direction();
    if (one_in(3)) heading = in_plane_of(normal, heading);
    const double before = distance();
    sim::Ray made{.origin = point_of(disc, normal) - before * heading, .direction = stretched(heading)};
    if (one_in(6)) made.origin = offset_ + scale_ * place();
    if (!one_in(3)) made.length = length(before);
    made.power = one_power_ ? 1 : bytes_.PickValueInArray({1.0, 0.0, -0.0, 0.1, 5e-324, 1e-300, 7.0, 1e60});
    return made;
  }

  /// A direction in the plane, or nearly in it.
  glm::dvec3 in_plane_of(const glm::dvec3& normal, const glm::dvec3& heading) {
    glm::dvec3 made = heading - glm::dot(heading, normal) * normal;
    made += bytes_.PickValueInArray({0.0, 0.0, 1e-17, 1e-12, 1e-7, 1e-4}) * normal;
    made = sim::unit_or_zero(made);
    return made == glm::dvec3{0} ? heading : made;
  }

  double distance() {
    return scale_ * bytes_.PickValueInArray({0.0, 1.0, 0.5, 2.0, 1e-8, 1e3, 1e9, -1.0, 1e-17, 1.7320508075688772});
  }

  /// Length of a segment whose origin is at distance `before` from the disc's plane: it often just reaches the plane.
  double length(double before) {
    const double whole = std::abs(before) > 0 ? std::abs(before) : radius_;
    switch (bytes_.ConsumeIntegralInRange(0, 7)) {
      case 0:
      case 1:
        return whole;
      case 2:
        return std::nextafter(whole, 0) > 0 ? std::nextafter(whole, 0) : whole;
      case 3:
        return std::nextafter(whole, 1e300);
      case 4:
        return whole * (1 + 1e-12);
      case 5:
        return bytes_.PickValueInArray({1e-300, 5e-324, 1e300, 1e99});
      default:
        return whole * bytes_.PickValueInArray({0.5, 2.0, 10.0});
    }
  }

  FuzzedDataProvider& bytes_;
  double scale_;
  glm::dvec3 offset_;
  double radius_;
  bool one_plane_;
  bool one_power_;
};

}  // namespace detp::fuzz
