#include "choosers.hpp"

#include "detp/model/rank/choose.hpp"
#include "detp/sim/base/stopwatch.hpp"

namespace detp::validate {
namespace {

Choice estimate(const Job& job, const CostTable& costs) {
  const sim::Stopwatch watch;
  const model::Ranked first = model::rank(job.workload, costs).front();
  return {first.candidate, first.time.total(), watch.seconds()};
}

}  // namespace

std::vector<Chooser> all_choosers(const CostTable& costs) {
  return {{"estimate", [costs](const sim::Problem& /*problem*/, const Job& job) { return estimate(job, costs); }}};
}

}  // namespace detp::validate
