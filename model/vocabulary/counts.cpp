#include "counts.hpp"

#include "checks.hpp"

namespace detp {

void check(const UnitCosts& costs) {
  require_non_negative("time of a ray-sphere test", costs.sphere_test);
  require_non_negative("time of a ray-disc test", costs.disc_test);
  require_non_negative("time of a test of a disc in a cell", costs.index_test);
  require_non_negative("time of a step to a cell", costs.step);
  require_non_negative("time of a visit to a node", costs.node);
  require_non_negative("time of a copy into a list", costs.copy);
  require_non_negative("time of placing a disc", costs.placement);
  require_non_negative("time of sorting a sample", costs.sort);
  require_non_negative("fixed time of a rebuild", costs.rebuild);
}

}  // namespace detp
