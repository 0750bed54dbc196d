#include "experiments.hpp"

#include <array>
#include <utility>

#include "detp/sim/base/stopped.hpp"

namespace detp::validate {

namespace {

using Run = std::vector<Finding> (*)(const Experiment&);

/// False if a stop request ended the experiment.
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

std::vector<Finding> all_findings(const Experiment& experiment, const Progress& progress, sim::Progress* done) {
  struct Step {
    std::string_view name;
    Run run;
    double share;  ///< approximate share of the whole time
  };
  constexpr std::array steps{
      Step{"predictions of the choice", choice_findings, 0},
      Step{"lines against spheres and discs", line_hit_findings, 0.2}, Step{"sphere cache", sphere_cache_findings, 0.5},
      Step{"hierarchies of spheres", sphere_hierarchy_findings, 0.1}, Step{"index of discs", disc_index_findings, 0.2}};
  std::vector<Finding> findings;
  std::uint64_t experiments = 0;
  double share = 0;
  for (const Step& step : steps) {
    if (progress) progress(step.name, share);
    if (!add_findings(step.run, experiment, findings)) break;
    share += step.share;
    ++experiments;
  }
  if (done != nullptr) *done = {experiments, steps.size(), "experiments"};
  return findings;
}

}  // namespace detp::validate
