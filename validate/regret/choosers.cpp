#include "choosers.hpp"

#include "detp/model/rank/paper_rule.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/validate/choice/analysis.hpp"
#include "detp/validate/choice/pilot.hpp"

namespace detp::validate {
namespace {

std::vector<Candidate> box_trees(const Workload& /*workload*/) {
  std::vector<Candidate> all;
  for (const int fan_out : {4, 8, 16})
    for (const int leaf : {16, 64}) all.push_back({Technique::box_tree, BoxTreeParameters{fan_out, leaf}});
  return all;
}

std::vector<Candidate> usual_box_tree(const Workload& workload) {
  return {{Technique::box_tree, usual_shape(workload.rays, workload.samples)}};
}

std::vector<Candidate> by_paper_rule(const Workload& workload) { return {model::paper_rule(workload)}; }

std::vector<Candidate> embree(const Workload& /*workload*/) {
  return {{Technique::bvh, BvhParameters{BuildQuality::low}}, {Technique::bvh, BvhParameters{BuildQuality::medium}}};
}

std::vector<Candidate> brute_force(const Workload& /*workload*/) { return {default_candidate(Technique::brute_force)}; }

Chosen chosen(const Choice& choice, double seconds_before = 0) {
  return {choice.best(), seconds_before + choice.choosing_seconds};
}

template <Purpose purpose>
Chosen by_pilot(const sim::Problem& problem, const Job& /*job*/, const CostTable& costs, int threads) {
  return chosen(choose({.problem = &problem, .purpose = purpose, .threads = threads}, costs));
}

template <Rigor rigor>
Chosen by_workload(const sim::Problem& problem, const Job& job, const CostTable& costs, int threads) {
  return chosen(choose({.problem = &problem, .workload = job.workload(), .rigor = rigor, .threads = threads}, costs),
                job.observed().seconds);
}

/// The candidates of the pilot, the other techniques and neighbours of the fastest, each run several times.
Chosen by_runs(const sim::Problem& problem, const Job& /*job*/, const CostTable& costs, int threads) {
  const sim::Stopwatch watch;
  const Choice found = choose({.problem = &problem, .threads = threads}, costs);
  const Analysis analysis = analyse(problem, found.candidates, {.threads = threads});
  const Analysed& best = analysis.candidates.at(analysis.best.value_or(0));
  return {{.candidate = best.candidate, .time = {.intersect = *best.seconds}, .threads = best.threads},
          watch.seconds()};
}

}  // namespace

std::vector<Chooser> all_choosers(const CostTable& costs) {
  const auto tier = [&costs](const char* name, auto* choose) {
    return Chooser{name, [costs, choose](const sim::Problem& problem, const Job& job, int threads) {
                     return choose(problem, job, costs, threads);
                   }};
  };
  return {tier("pilot", by_pilot<Purpose::prediction>), tier("run", by_pilot<Purpose::one_search>),
          tier("structural", by_workload<Rigor::structural>), tier("estimate", by_workload<Rigor::estimate>),
          tier("measure", by_runs)};
}

const std::array<Baseline, 5>& baselines() {
  static const std::array<Baseline, 5> all{{{"best_constant", "best constant", false, box_trees},
                                            {"usual_shape", "usual shape", true, usual_box_tree},
                                            {"paper_rule", "paper's rule", true, by_paper_rule},
                                            {"always_embree", "always Embree", false, embree},
                                            {"always_brute_force", "always brute force", false, brute_force}}};
  return all;
}

}  // namespace detp::validate
