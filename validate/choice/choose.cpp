#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "choice.hpp"
#include "comparison.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/technique/piloted_discs.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "pilot.hpp"

namespace detp::validate {
namespace {

/// The question with its rays and their number.
Question completed(Question question) {
  if (question.rays.empty() && question.problem != nullptr) question.rays = question.problem->rays();
  if (!question.ray_count) {
    if (!question.rays.empty()) question.ray_count = static_cast<double>(question.rays.size());
    if (question.rays.empty() && question.workload) question.ray_count = question.workload->rays;
  }
  if (!question.ray_count) throw std::invalid_argument("a choice needs rays, or their number");
  require_count("number of rays", *question.ray_count, 1, 1e18);
  return question;
}

/// Whether the powers of some of the rays differ.
bool powers_differ(const Question& question) {
  const auto differ = [](std::span<const sim::Ray> rays) {
    constexpr std::size_t most = 2048;
    const std::size_t step = rays.size() / most + 1;
    for (std::size_t i = step; i < rays.size(); i += step)
      if (rays[i].power != rays.front().power) return true;
    return false;
  };
  const bool all_known = question.problem != nullptr && !question.problem->rays().empty();
  return all_known ? !question.problem->one_power() : differ(question.rays);
}

Choice by_closed_forms(const Question& question, const Valid<CostTable>& given) {
  if (!can_measure(question))
    throw std::invalid_argument("closed forms need a workload, or discs and rays to measure it on");
  const sim::Stopwatch watch;
  const Valid<CostTable> costs(costs_for(question, given));
  Choice found;
  found.candidates = allowed_ranking(evidence(question, *question.ray_count), costs, question.disabled,
                                     {.threads = sim::useful_threads(question.threads), .stop = question.stop});
  if (found.candidates.empty()) {
    if (question.stop.stop_requested())
      throw sim::Stopped("stopped before a technique that is not disabled was ranked");
    throw std::invalid_argument("no technique is left that can be predicted");
  }
  found.choosing_seconds = watch.seconds();
  return found;
}

}  // namespace

bool Question::allows(Technique technique) const { return std::ranges::find(disabled, technique) == disabled.end(); }

Rigor reachable_rigor(const Question& question, const CostTable& costs) {
  const bool rays = question.problem != nullptr && (!question.rays.empty() || !question.problem->rays().empty());
  const bool pilot = rays && costs.engine == Engine::simd && question.allows(Technique::box_tree) &&
                     sim::PilotedDiscs::can_pilot(*question.problem);
  return pilot ? Rigor::pilot : Rigor::estimate;
}

CostTable costs_for(const Question& question, const CostTable& costs) {
  return powers_differ(question) ? costs_of_sums(costs) : costs;
}

Choice choose(const Question& question, const Valid<CostTable>& costs) {
  const sim::DefaultFloatingPoint mode;
  const Question all = completed(question);
  const Rigor rigor = all.rigor.value_or(reachable_rigor(all, costs));
  if (rigor == Rigor::measure) throw std::invalid_argument("a choice by measurement is made by analyse");
  Choice found = rigor == Rigor::estimate ? by_closed_forms(all, costs) : choose_by_sample(all, rigor, costs);
  found.rigor = rigor;
  return found;
}

Choice choose_again(const Choice& choice, const Question& question, double radius_ratio, double rays,
                    const Valid<CostTable>& costs) {
  const sim::DefaultFloatingPoint mode;
  require_positive("ratio of the radii", radius_ratio);
  Question changed = completed(question);
  changed.ray_count = rays;
  require_count("number of rays", rays, 1, 1e18);
  if (changed.workload) {
    changed.workload->rays = rays;
    changed.workload = with_disc_radius(*changed.workload, radius_ratio * changed.workload->disc_radius);
  }
  Choice found = choice.rigor == Rigor::estimate ? by_closed_forms(changed, costs)
                                                 : sample_again(choice, changed, radius_ratio, costs);
  found.rigor = choice.rigor;
  return found;
}

std::unique_ptr<sim::Index> build_choice(Choice& choice, const sim::Problem& problem, const sim::RunOptions& options) {
  const Candidate& candidate = choice.best().candidate;
  if (!choice.discs || candidate.technique != Technique::box_tree) return sim::prepare(problem, candidate, options);
  const auto discs = std::exchange(choice.discs, nullptr);
  return std::move(*discs).build(problem, std::get<BoxTreeParameters>(candidate.parameters), options);
}

}  // namespace detp::validate
