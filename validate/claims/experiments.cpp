#include "experiments.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/validate/base/json.hpp"
#include "findings_until.hpp"

namespace detp::validate {

namespace {

constexpr std::array steps_of_all{
    ExperimentStep{"choice", "predictions of the choice", choice_findings, choice_work, 3, false},
    ExperimentStep{"effects", "effects", effect_findings, effect_work, 3, false},
    ExperimentStep{"lines", "lines against spheres and discs", line_hit_findings, line_hit_work, 1, true},
    ExperimentStep{"sphere-cache", "sphere cache", sphere_cache_findings, sphere_cache_work, 1, true},
    ExperimentStep{"hierarchies", "hierarchies of spheres and boxes", hierarchy_findings, hierarchy_work, 2.2, true},
    ExperimentStep{"index", "index of discs", disc_index_findings, disc_index_work, 7.5, true},
    ExperimentStep{"errors", "errors of estimates", accuracy_findings, accuracy_work, 1, true}};

}  // namespace

std::span<const ExperimentStep> experiment_steps() { return steps_of_all; }

std::vector<Finding> all_findings(const Experiment& experiment, const sim::ReportPhase& progress, sim::Progress* done,
                                  std::span<const ExperimentStep> steps) {
  const sim::DefaultFloatingPoint mode;
  std::vector<double> costs;
  double whole = 0;
  for (const ExperimentStep& step : steps) whole += costs.emplace_back(step.work(experiment) * step.unit_time);
  SharedFindings shared(experiment, steps);
  const bool alone = shared.at_once() == 1;
  std::vector<Finding> findings;
  std::uint64_t experiments = 0;
  double share = 0;
  while (experiments < steps.size()) {  // one after another, or all at once
    const std::size_t end = alone ? experiments + 1 : steps.size();
    std::vector<Repetition> next;
    for (std::size_t i = experiments; i < end; ++i) next.push_back({i, 0});
    const double before = share;
    share = std::accumulate(costs.begin(), costs.begin() + static_cast<std::ptrdiff_t>(end), 0.0) / whole;
    const ExperimentStep& first = steps[experiments];
    if (progress)
      progress({alone ? first.name : "all experiments", before, share, costs[experiments] / first.unit_time});
    std::vector<FoundOnce> found = shared.find(next, alone ? std::vector<double>{} : costs);
    const auto finished = std::ranges::find(found, true, &FoundOnce::stopped);
    for (auto one = found.begin(); one != finished; ++one, ++experiments)
      for (Finding& finding : one->findings) findings.push_back(std::move(finding));
    if (finished != found.end()) break;
  }
  if (done != nullptr) *done = {experiments, steps.size(), "experiments"};
  return findings;
}

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Repetition, step, number)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FoundOnce, findings, seconds, stopped)

SharedFindings::SharedFindings(const Experiment& experiment, std::span<const ExperimentStep> steps)
    : experiment_(experiment),
      steps_(steps),
      work_([this](const std::string& task) { return json_bytes(find_here(from_json_bytes<Repetition>(task))); }) {
  if (experiment.ranks != nullptr) farm_.emplace(*experiment.ranks, work_);
}

std::size_t SharedFindings::at_once() const {
  return experiment_.ranks == nullptr ? 1 : static_cast<std::size_t>(experiment_.ranks->count());
}

std::vector<FoundOnce> SharedFindings::find(const std::vector<Repetition>& repetitions,
                                            const std::vector<double>& costs) {
  std::vector<FoundOnce> found;
  if (!farm_) {
    for (const Repetition& repetition : repetitions) found.push_back(find_here(repetition));
    return found;
  }
  std::vector<std::string> tasks;
  for (const Repetition& repetition : repetitions) tasks.push_back(json_bytes(repetition));
  for (const std::string& result : farm_->all(tasks, costs)) found.push_back(from_json_bytes<FoundOnce>(result));
  return found;
}

FoundOnce SharedFindings::find_here(const Repetition& repetition) const {
  Experiment one = experiment_;
  one.seed += repetition.number * 1'000'000'007ULL;
  const sim::Stopwatch watch;
  FoundOnce found;
  try {
    found.findings = steps_[repetition.step].run(one);
    found.stopped = found.findings.empty() && experiment_.stop.stop_requested();
  } catch (const sim::Stopped&) {
    found.stopped = true;
  }
  found.seconds = watch.seconds();
  return found;
}

void serve_findings(const Experiment& experiment, std::span<const ExperimentStep> steps) {
  const sim::DefaultFloatingPoint mode;
  SharedFindings(experiment, steps).serve();
}

}  // namespace detp::validate
