#include "choosers.hpp"

#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/technique/searcher.hpp"
#include "detp/validate/choice/allowed_ranking.hpp"
#include "detp/validate/choice/analysis.hpp"
#include "detp/validate/choice/structural_choice.hpp"

namespace detp::validate {
namespace {

Choice estimate(const Job& job, const CostTable& costs, int threads) {
  const sim::Stopwatch watch;
  const model::Ranked first = allowed_ranking(job.workload, costs, {}, {.threads = threads}).front();
  return {first.candidate, first.time.total(), job.observed.seconds + watch.seconds(), first.threads};
}

Choice by_pilot(const PilotChoice& found, double seconds_before) {
  const Piloted& choice = found.choice();
  return {choice.candidate, found.predicted ? choice.time.total() : 0, seconds_before + found.pilot_seconds,
          choice.threads};
}

Choice pilot(const sim::Problem& problem, const CostTable& costs, int threads, bool only_choice) {
  return by_pilot(choose_by_pilot(problem, costs, {.threads = threads, .only_choice = only_choice}), 0);
}

Choice structural(const sim::Problem& problem, const Job& job, const CostTable& costs, int threads) {
  const sim::Problem for_lines = sim::searched_problem(problem.discs(), {}, problem.front_facing(), {});
  return by_pilot(choose_by_structure(for_lines, job.workload, costs, {.threads = threads}), job.observed.seconds);
}

/// The candidates of the pilot, the other techniques and neighbours of the fastest, each run several times.
Choice measure(const sim::Problem& problem, const CostTable& costs, int threads) {
  const sim::Stopwatch watch;
  const PilotChoice found = choose_by_pilot(problem, costs, {.threads = threads});
  std::vector<model::Ranked> ranking;
  for (const Piloted& one : found.candidates) ranking.push_back({one.candidate, one.counts, one.time, {}, one.threads});
  const Analysis analysis = analyse(problem, ranking, {.threads = threads});
  const Analysed& best = analysis.candidates.at(analysis.best.value_or(0));
  return {best.candidate, *best.seconds, watch.seconds(), best.threads};
}

}  // namespace

std::vector<Chooser> all_choosers(const CostTable& costs) {
  return {{"pilot", [costs](const sim::Problem& problem, const Job& /*job*/,
                            int threads) { return pilot(problem, costs, threads, false); }},
          {"run", [costs](const sim::Problem& problem, const Job& /*job*/,
                          int threads) { return pilot(problem, costs, threads, true); }},
          {"structural", [costs](const sim::Problem& problem, const Job& job,
                                 int threads) { return structural(problem, job, costs, threads); }},
          {"estimate", [costs](const sim::Problem& /*problem*/, const Job& job,
                               int threads) { return estimate(job, costs, threads); }},
          {"measure", [costs](const sim::Problem& problem, const Job& /*job*/, int threads) {
             return measure(problem, costs, threads);
           }}};
}

}  // namespace detp::validate
