#include "directed_rays.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "detp/model/vocabulary/checks.hpp"
#include "line_measure.hpp"

namespace detp::model {
namespace {

using std::numbers::pi;

constexpr double far_away = 300;  // in disc radii
constexpr double least_complement = 1e-3;

/// The complete elliptic integrals of the first and second kind.
struct Elliptic {
  double first;   ///< K(k)
  double second;  ///< E(k)
};

/// `complement`: k' = √(1 - k²). For a small k', where 1 - k² would cancel, to the second order: the error is about
/// k'⁴ ln(4/k').
Elliptic elliptic(double modulus, double complement) {
  if (complement >= least_complement) return {boost::math::ellint_1(modulus), boost::math::ellint_2(modulus)};
  const double logarithm = std::log(4 / complement);
  const double squared = complement * complement;
  return {logarithm + (logarithm - 1) * squared / 4, 1 + (logarithm - 0.5) * squared / 2};
}

/// Heuman's lambda function of the modulus k: 2/π (E(k) F(ξ, k') + K(k) (E(ξ, k') - F(ξ, k'))).
double heuman_lambda(const Elliptic& complete, double complement, double angle) {
  const double first = boost::math::ellint_1(complement, angle);
  const double second = boost::math::ellint_2(complement, angle);
  return 2 / pi * (complete.second * first + complete.first * (second - first));
}

double series_far_away(double height, double offset) {
  const double distance = std::hypot(height, offset);
  const double sine = offset / distance;
  const double correction = 1 + (15 * sine * sine - 6) / (8 * distance * distance);
  return pi * (height / distance) / distance / distance * correction;
}

}  // namespace

double parallel_disc_hit_probability(DiscRadius disc, SphereRadius outer, double cosine) {
  if (!(std::abs(cosine) <= 1)) throw std::invalid_argument(fmt::format("cosine must be in [-1, 1] (got {})", cosine));
  return 2 * std::abs(cosine) * disc_hit_probability(disc, outer);
}

double disc_solid_angle(DiscRadius disc, const PointOverDisc& point) {
  require_positive("disc radius", disc.value);
  require_non_negative("height of the point", point.height);
  require_non_negative("offset of the point", point.offset);
  const double height = point.height / disc.value;
  const double offset = point.offset / disc.value;
  if (std::hypot(height, offset) > far_away) return series_far_away(height, offset);
  if (height == 0) return offset < 1 ? 2 * pi : offset > 1 ? 0 : pi;
  const double reach = std::hypot(height, offset + 1);
  const double complement = std::min(1.0, std::hypot(height, offset - 1) / reach);
  const Elliptic complete = elliptic(2 * std::sqrt(offset) / reach, complement);
  const double first = 2 * height / reach * complete.first;
  if (offset == 1) return pi - first;
  const double lambda = pi * heuman_lambda(complete, complement, std::atan2(height, std::abs(offset - 1)));
  return offset < 1 ? 2 * pi - first - lambda : lambda - first;
}

double sphere_solid_angle(SphereRadius sphere, double distance) {
  require_positive("sphere radius", sphere.value);
  require_non_negative("distance of the point", distance);
  if (distance <= sphere.value) return 4 * pi;
  const double ratio = sphere.value / distance;
  return 2 * pi * ratio * ratio / (1 + std::sqrt((1 - ratio) * (1 + ratio)));
}

double point_disc_hit_probability(DiscRadius disc, const PointOverDisc& point, SphereRadius outer, double distance) {
  return disc_solid_angle(disc, point) / sphere_solid_angle(outer, distance);
}

}  // namespace detp::model
