#include "optimal_ratio.hpp"

#include <fmt/format.h>

#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::model {

double optimal_ratio(double dimension) {
  if (!(dimension >= 1 && dimension <= 3))
    throw std::invalid_argument(fmt::format("sample dimension must be from 1 to 3 (got {})", dimension));
  const long double beyond = dimension - 2;
  return static_cast<double>(std::exp(beyond == 0 ? -0.5L : -std::log1p(beyond / 2) / beyond));
}

double optimal_ratio_with_copies(double copy_over_test) {
  require_non_negative("cost of a copy over that of a test", copy_over_test);
  // The unknown y is Q γ^{1/3} if γ > 1, else Q. So for any γ, the root of a y³ + b y - 2 lies between 0.59 and 1.26.
  const long double scale = copy_over_test > 1 ? std::cbrt(static_cast<long double>(copy_over_test)) : 1;
  const long double a = copy_over_test > 1 ? 1 : copy_over_test;
  const long double b = 3 / scale;
  const auto cubic = [&](long double y) { return std::pair{(a * y * y + b) * y - 2, 3 * a * y * y + b}; };
  std::uintmax_t steps = 100;
  return static_cast<double>(boost::math::tools::newton_raphson_iterate(cubic, 0.6L, 0.0L, 2.0L, 60, steps) / scale);
}

}  // namespace detp::model
