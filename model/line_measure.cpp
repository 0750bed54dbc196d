#include "line_measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace detp::model {
namespace {

using std::numbers::pi;

void require_inside(std::string_view what, double size, double outer) {
  if (size > outer)
    throw std::invalid_argument(
        fmt::format("{} must not exceed the sphere radius {}, or it pokes out (got {})", what, outer, size));
}

/// Area common to two circles of radii a and b whose centres are c apart.
double lens_area(double a, double b, double c) {
  if (c >= a + b) return 0;
  const double small = std::min(a, b);
  if (c <= std::abs(a - b)) return pi * small * small;
  const double from_a = (c * c + a * a - b * b) / (2 * c);
  const double from_b = c - from_a;
  const auto segment = [](double r, double x) {
    const double cosine = std::clamp(x / r, -1.0, 1.0);
    return r * r * (std::acos(cosine) - cosine * std::sqrt((1 - cosine) * (1 + cosine)));
  };
  return segment(a, from_a) + segment(b, from_b);
}

}  // namespace

double sphere_hit_probability(SphereRadius inner, SphereRadius outer) {
  require_positive("sphere radius", inner.value);
  require_positive("sphere radius", outer.value);
  require_inside("inner sphere radius", inner.value, outer.value);
  const double ratio = inner.value / outer.value;
  return ratio * ratio;
}

double disc_hit_probability(DiscRadius disc, SphereRadius outer) {
  require_positive("disc radius", disc.value);
  require_positive("sphere radius", outer.value);
  require_inside("disc radius", disc.value, outer.value);
  const double ratio = disc.value / outer.value;
  return ratio * ratio / 2;
}

double cube_hit_probability(double side, SphereRadius outer) {
  require_positive("cube side", side);
  require_positive("sphere radius", outer.value);
  require_inside("half the cube's diagonal", side * std::sqrt(0.75) * (1 - 1e-12), outer.value);
  const double ratio = side / outer.value;
  return 1.5 / pi * ratio * ratio;
}

double crossing_probability(const Workload& workload, double volume, double area) {
  check(workload);
  require_non_negative("volume of the body", volume);
  require_non_negative("surface area of the body", area);
  if (workload.path_length <= 0)
    return std::min(1.0, area / (4 * pi * workload.sphere_radius * workload.sphere_radius));
  double space = 1;
  for (const double side : workload.box) space *= side + 2 * workload.disc_radius;
  return std::min(1.0, (volume + workload.path_length * area / 4) / space);
}

double expected_hits(const Workload& workload) {
  const double d = workload.disc_radius;
  return workload.rays * workload.samples * crossing_probability(workload, 0, 2 * pi * d * d);
}

double both_hit_share(double a, double b, double c) {
  require_positive("sphere radius", a);
  require_positive("sphere radius", b);
  require_non_negative("distance of the centres", c);
  if (c + b <= a) return 1;
  // Seen within `covered` of the line of centres, the smaller circle lies in the larger one; beyond `apart`, the two do
  // not meet. Between, u -> u²(3 - 2u) smooths the lens's ends, where it goes with the power 3/2.
  const double covered = std::asin(std::min(1.0, std::abs(a - b) / c));
  const double apart = std::asin(std::min(1.0, (a + b) / c));
  const auto lens_at = [&](double u) {
    const double angle = covered + (apart - covered) * u * u * (3 - 2 * u);
    return lens_area(a, b, c * std::sin(angle)) * std::sin(angle) * 6 * u * (1 - u);
  };
  const double lenses = (apart - covered) * boost::math::quadrature::gauss<double, 30>::integrate(lens_at, 0, 1);
  const double small = std::min(a, b);
  const double covered_share = 2 * std::pow(std::sin(covered / 2), 2);  // 1 - cos
  return covered_share * (small / b) * (small / b) + lenses / (pi * b * b);
}

}  // namespace detp::model
