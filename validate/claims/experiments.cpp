#include "experiments.hpp"

#include <array>
#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopped.hpp"

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

/// Returns false if a stop request ended the experiment.
bool add_findings(std::vector<Finding> (*run)(const Experiment&), const Experiment& experiment,
                  std::vector<Finding>& findings) {
  try {
    std::vector<Finding> found = run(experiment);
    if (found.empty() && experiment.stop.stop_requested()) return false;
    for (Finding& finding : found) findings.push_back(std::move(finding));
    return true;
  } catch (const sim::Stopped&) {
    return false;
  }
}

}  // namespace

std::span<const ExperimentStep> experiment_steps() { return steps_of_all; }

std::vector<Finding> all_findings(const Experiment& experiment, const sim::ReportPhase& progress, sim::Progress* done,
                                  std::span<const ExperimentStep> steps) {
  const sim::DefaultFloatingPoint mode;
  std::vector<double> work(steps.size());
  double whole = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    work[i] = progress ? steps[i].work(experiment) : 0;
    whole += work[i] * steps[i].unit_time;
  }
  std::vector<Finding> findings;
  std::uint64_t experiments = 0;
  double share = 0;
  for (const ExperimentStep& step : steps) {
    const double before = share;
    share += whole > 0 ? work[experiments] * step.unit_time / whole : 0;
    if (progress) progress({step.name, before, share, work[experiments]});
    if (!add_findings(step.run, experiment, findings)) break;
    ++experiments;
  }
  if (done != nullptr) *done = {experiments, steps.size(), "experiments"};
  return findings;
}

}  // namespace detp::validate
