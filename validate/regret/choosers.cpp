#include "choosers.hpp"

#include "detp/sim/base/stopwatch.hpp"
#include "detp/validate/choice/analysis.hpp"

namespace detp::validate {
namespace {

Chosen chosen(const Choice& choice, double seconds_before = 0) {
  return {choice.best(), seconds_before + choice.choosing_seconds};
}

Chosen pilot(const sim::Problem& problem, const CostTable& costs, int threads, Purpose purpose) {
  return chosen(choose({.problem = &problem, .purpose = purpose, .threads = threads}, costs));
}

Chosen by_workload(Rigor rigor, const sim::Problem& problem, const Job& job, const CostTable& costs, int threads) {
  return chosen(choose({.problem = &problem, .workload = job.workload(), .rigor = rigor, .threads = threads}, costs),
                job.observed().seconds);
}

/// The candidates of the pilot, the other techniques and neighbours of the fastest, each run several times.
Chosen measure(const sim::Problem& problem, const CostTable& costs, int threads) {
  const sim::Stopwatch watch;
  const Choice found = choose({.problem = &problem, .threads = threads}, costs);
  const Analysis analysis = analyse(problem, found.candidates, {.threads = threads});
  const Analysed& best = analysis.candidates.at(analysis.best.value_or(0));
  return {{.candidate = best.candidate, .time = {.intersect = *best.seconds}, .threads = best.threads},
          watch.seconds()};
}

}  // namespace

std::vector<Chooser> all_choosers(const CostTable& costs) {
  return {{"pilot", [costs](const sim::Problem& problem, const Job& /*job*/,
                            int threads) { return pilot(problem, costs, threads, Purpose::prediction); }},
          {"run", [costs](const sim::Problem& problem, const Job& /*job*/,
                          int threads) { return pilot(problem, costs, threads, Purpose::one_search); }},
          {"structural", [costs](const sim::Problem& problem, const Job& job,
                                 int threads) { return by_workload(Rigor::structural, problem, job, costs, threads); }},
          {"estimate", [costs](const sim::Problem& problem, const Job& job,
                               int threads) { return by_workload(Rigor::estimate, problem, job, costs, threads); }},
          {"measure", [costs](const sim::Problem& problem, const Job& /*job*/, int threads) {
             return measure(problem, costs, threads);
           }}};
}

}  // namespace detp::validate
