#include "choosers.hpp"

#include "detp/model/rank/choose.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/technique/searcher.hpp"
#include "detp/validate/choice/structural_choice.hpp"

namespace detp::validate {
namespace {

Choice estimate(const Job& job, const CostTable& costs) {
  const sim::Stopwatch watch;
  const model::Ranked first = model::rank(job.workload, costs).front();
  return {first.candidate, first.time.total(), job.measure_seconds + watch.seconds()};
}

Choice pilot(const sim::Problem& problem, const CostTable& costs) {
  const PilotChoice found = choose_by_pilot(problem, costs);
  return {found.choice().candidate, found.choice().time.total(), found.pilot_seconds};
}

Choice structural(const sim::Problem& problem, const Job& job, const CostTable& costs) {
  const sim::Problem for_lines = sim::searched_problem(problem.discs(), {}, problem.front_facing(), {});
  const PilotChoice found = choose_by_structure(for_lines, job.workload, costs);
  return {found.choice().candidate, found.choice().time.total(), job.measure_seconds + found.pilot_seconds};
}

}  // namespace

std::vector<Chooser> all_choosers(const CostTable& costs) {
  return {
      {"pilot", [costs](const sim::Problem& problem, const Job& /*job*/) { return pilot(problem, costs); }},
      {"structural", [costs](const sim::Problem& problem, const Job& job) { return structural(problem, job, costs); }},
      {"estimate", [costs](const sim::Problem& /*problem*/, const Job& job) { return estimate(job, costs); }}};
}

}  // namespace detp::validate
