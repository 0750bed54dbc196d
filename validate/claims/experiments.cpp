#include "experiments.hpp"

#include <array>
#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopped.hpp"

namespace detp::validate {

namespace {

using Run = std::vector<Finding> (*)(const Experiment&);

/// Returns false if a stop request ended the experiment.
bool add_findings(Run run, const Experiment& experiment, std::vector<Finding>& findings) {
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

std::vector<Finding> all_findings(const Experiment& experiment, const sim::ReportPhase& progress, sim::Progress* done) {
  const sim::DefaultFloatingPoint mode;
  struct Step {
    const char* name;
    Run run;
    double (*work)(const Experiment&);
    double unit_time;  ///< measured time of a unit of the step's work, relative to that of "sphere cache"
  };
  constexpr std::array steps{Step{"predictions of the choice", choice_findings, choice_work, 3},
                             Step{"effects", effect_findings, effect_work, 3},
                             Step{"lines against spheres and discs", line_hit_findings, line_hit_work, 1},
                             Step{"sphere cache", sphere_cache_findings, sphere_cache_work, 1},
                             Step{"hierarchies of spheres and boxes", hierarchy_findings, hierarchy_work, 2.2},
                             Step{"index of discs", disc_index_findings, disc_index_work, 7.5},
                             Step{"errors of estimates", accuracy_findings, accuracy_work, 1}};
  std::array<double, steps.size()> work{};
  double whole = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    work[i] = progress ? steps[i].work(experiment) : 0;
    whole += work[i] * steps[i].unit_time;
  }
  std::vector<Finding> findings;
  std::uint64_t experiments = 0;
  double share = 0;
  for (const Step& step : steps) {
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
