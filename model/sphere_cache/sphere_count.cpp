#include "sphere_count.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <stdexcept>

namespace detp::model {
namespace {

using Exact = boost::multiprecision::cpp_bin_float_100;

/// Q^n by squaring: relative error below n 1e-100.
Exact power(double base, std::int64_t exponent) {
  Exact result = 1;
  for (Exact square = base; exponent > 0; exponent /= 2, square *= square)
    if (exponent % 2 == 1) result *= square;
  return result;
}

/// The sign of r₀Qⁿ - d.
int compare(double ratio, std::int64_t n, double disc, double outer) {
  const Exact radius = power(ratio, n) * Exact{outer};
  return radius.compare(Exact{disc});
}

/// ln(large/small), accurate to the last digits also if the two are almost equal.
long double log_of_ratio(long double large, long double small) {
  return small > large / 2 ? -std::log1p((small - large) / large) : std::log(large / small);
}

}  // namespace

std::int64_t sphere_count(Form form, RadiusRatio ratio, DiscRadius disc, SphereRadius outer) {
  require_ratio("radius ratio Q", ratio.value);
  require_positive("disc radius", disc.value);
  require_positive("sphere radius", outer.value);
  if (disc.value >= outer.value) return 0;
  const long double log_radii = log_of_ratio(outer.value, disc.value);
  const long double exact = log_radii / -std::log(static_cast<long double>(ratio.value));
  if (exact > 9e18L) throw std::overflow_error("the number of spheres exceeds 9e18");
  const long double nearest = std::round(exact);
  if (std::abs(exact - nearest) > 1e-12L * (1 + exact))
    return static_cast<std::int64_t>(form == Form::published ? std::ceil(exact) : std::floor(exact));
  // The logarithms are not accurate enough to round a value so close to a whole number. The powers are.
  auto k = static_cast<std::int64_t>(nearest);
  while (k > 0 && compare(ratio.value, k, disc.value, outer.value) < 0) --k;
  while (compare(ratio.value, k + 1, disc.value, outer.value) >= 0) ++k;
  const bool tie = compare(ratio.value, k, disc.value, outer.value) == 0;
  return form == Form::corrected || tie ? k : k + 1;
}

}  // namespace detp::model
