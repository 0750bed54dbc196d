#include "optimal_ratio.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace detp::model {

double optimal_ratio(double dimension) {
  if (!(dimension >= 1 && dimension <= 3))
    throw std::invalid_argument(fmt::format("sample dimension must be from 1 to 3 (got {})", dimension));
  const long double beyond = dimension - 2;
  return static_cast<double>(std::exp(beyond == 0 ? -0.5L : -std::log1p(beyond / 2) / beyond));
}

}  // namespace detp::model
