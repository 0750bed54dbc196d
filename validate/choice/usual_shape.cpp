#include "usual_shape.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/model/vocabulary/checks.hpp"

namespace detp::validate {

BoxTreeParameters usual_shape(double rays, double discs, double placing) {
  require_count("number of rays", rays, 1, 1e18);
  require_count("number of discs", discs, 1, 1e18);
  if (std::isnan(placing))
    throw std::invalid_argument("the ratio of the times for placing and testing must be a number");
  constexpr double least = 3;  // powers of two
  constexpr double most = 9;
  const double power = std::clamp(std::log2(24) + 0.3 * std::log2(discs / rays) +
                                      0.35 * std::log2(std::clamp(placing, 1.0, 1024.0) / usual_placing),
                                  least, most);
  return {8, 1 << std::lround(power)};
}

}  // namespace detp::validate
