#include "detp/model/closed_form/closed_form.hpp"
#include "detp/model/closed_form/reasons.hpp"
#include "detp/model/lines/line_measure.hpp"

namespace detp::model {
namespace {

Counts<double> each_pair(const Valid<Workload>& workload, const EachPairParameters&) {
  return {.disc_tests = workload.rays * workload.samples, .hits = expected_hits(workload)};
}

std::optional<FoundParameters> best_step(const Valid<Workload>&, const Valid<UnitCosts>&, const FixedParameters&,
                                         const SearchLimits&) {
  return tuned(std::optional(EachPairParameters{2}));
}

}  // namespace

TechniqueModel model_each_pair() {
  return {predicted<EachPairParameters, each_pair>, best_step, [](const auto&, const auto&, Reasons&) {}};
}

}  // namespace detp::model
