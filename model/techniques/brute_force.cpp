#include "detp/model/closed_form/closed_form.hpp"
#include "detp/model/lines/line_measure.hpp"

namespace detp::model {
namespace {

/// Plain density estimation on the tangent plane: each disc against each ray.
Counts<double> brute_force(const Valid<Workload>& workload, const BruteForceParameters&) {
  return {.visits = workload.samples, .disc_tests = workload.rays * workload.samples, .hits = expected_hits(workload)};
}

}  // namespace

TechniqueModel model_brute_force() { return {in_blocks<BruteForceParameters, brute_force>}; }

}  // namespace detp::model
