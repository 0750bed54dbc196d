#include "shared_findings.hpp"

#include <utility>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/validate/base/json.hpp"

namespace detp::validate {

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

}  // namespace detp::validate
