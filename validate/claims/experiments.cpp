#include "experiments.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "shared_findings.hpp"

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

void serve_findings(const Experiment& experiment, std::span<const ExperimentStep> steps) {
  const sim::DefaultFloatingPoint mode;
  SharedFindings(experiment, steps).serve();
}

}  // namespace detp::validate
