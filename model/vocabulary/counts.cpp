#include "counts.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <string_view>

namespace detp {
namespace {

/// Counts go up to some 1e55 (n_R n_P k): no time overflows.
constexpr double dearest = 1e200;

void require_time(std::string_view what, double value) {
  if (!(value >= 0 && value <= dearest))
    throw std::invalid_argument(fmt::format("{} must be from 0 to {} (got {})", what, dearest, value));
}

}  // namespace

void check(const UnitCosts& costs) {
  require_time("time of a ray-sphere test", costs.sphere_test);
  require_time("time of a ray-disc test", costs.disc_test);
  require_time("time of a test of a disc in a cell", costs.index_test);
  require_time("time of a step to a cell", costs.step);
  require_time("time of a visit to a node", costs.node);
  require_time("time of a copy into a list", costs.copy);
  require_time("time of placing a disc", costs.placement);
  require_time("time of sorting a sample", costs.sort);
  require_time("fixed time of a rebuild", costs.rebuild);
}

}  // namespace detp
