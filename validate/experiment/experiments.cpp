#include "experiments.hpp"

#include <array>
#include <utility>

namespace detp::validate {

std::vector<Finding> all_findings(const Experiment& experiment, const Progress& progress) {
  using Run = std::vector<Finding> (*)(const Experiment&);
  struct Step {
    std::string_view name;
    Run run;
    double share;  ///< of the whole time, roughly
  };
  constexpr std::array steps{
      Step{"predictions of the choice", choice_findings, 0},
      Step{"lines against spheres and discs", line_hit_findings, 0.2}, Step{"sphere cache", sphere_cache_findings, 0.5},
      Step{"hierarchies of spheres", sphere_hierarchy_findings, 0.1}, Step{"index of discs", disc_index_findings, 0.2}};
  std::vector<Finding> findings;
  double done = 0;
  for (const Step& step : steps) {
    if (progress) progress(step.name, done);
    for (Finding& finding : step.run(experiment)) findings.push_back(std::move(finding));
    done += step.share;
    if (experiment.stop.stop_requested()) break;
  }
  return findings;
}

}  // namespace detp::validate
