#include "usual_shape.hpp"

#include <algorithm>
#include <cmath>

#include "detp/model/vocabulary/checks.hpp"

namespace detp::validate {

BoxTreeParameters usual_shape(double rays, double discs) {
  require_count("number of rays", rays, 1, 1e18);
  require_count("number of discs", discs, 1, 1e18);
  constexpr double least = 3;  // powers of two
  constexpr double most = 9;
  const double power = std::clamp(std::log2(24) + 0.3 * std::log2(discs / rays), least, most);
  return {8, 1 << std::lround(power)};
}

}  // namespace detp::validate
