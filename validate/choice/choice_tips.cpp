#include "choice_tips.hpp"

#include <algorithm>
#include <stdexcept>

#include "detp/sim/base/threads.hpp"
#include "detp/sim/technique/piloted_discs.hpp"

namespace detp::validate {
namespace {

/// The pilot's choice, with counts that can be extrapolated.
PilotChoice with_growth(const PilotChoice& pilot) {
  PilotChoice found = pilot;
  for (Piloted& one : found.candidates) {
    const auto* shape = std::get_if<BoxTreeParameters>(&one.candidate.parameters);
    if (one.counts_at || shape == nullptr || !pilot.discs) continue;
    one.counts_at = [counts = pilot.discs->counts(*shape, true)](double radius_ratio, double rays) {
      return counts.at(radius_ratio, rays);
    };
  }
  return found;
}

Workload changed_workload(Workload workload, const TipInputs& inputs) {
  workload.rays = inputs.rays;
  return with_disc_radius(std::move(workload), inputs.disc_radius);
}

TippedChoice tipped(const PilotChoice& choice, const Candidate& present) {
  const Piloted& best = choice.choice();
  const double seconds = best.time.total();
  TippedChoice there{best.candidate, best.threads, seconds, seconds, choice.unexamined};
  for (const Piloted& one : choice.candidates) {
    const bool same = one.candidate.technique == best.candidate.technique;
    if (same && one.candidate == present) there.unchanged_seconds = one.time.total();
    if (!same && one.closed_form) there.not_ruled_out.push_back(one.candidate.technique);
  }
  return there;
}

}  // namespace

Tips tips_of(const PilotChoice& pilot, const sim::Problem& problem, const Workload& workload,
             const Valid<CostTable>& costs, const PilotOptions& options) {
  const PilotChoice counted = with_growth(pilot);
  const auto choose = [&](const TipInputs& inputs) -> std::optional<TippedChoice> {
    try {
      PilotOptions changed = options;
      changed.threads = inputs.threads;
      changed.all_closed_forms = true;
      changed.workload = changed_workload(workload, inputs);
      const double ratio = inputs.disc_radius / workload.disc_radius;
      return tipped(choose_again(counted, problem, ratio, inputs.rays, costs, changed), pilot.choice().candidate);
    } catch (const std::invalid_argument&) {  // no workload has this radius
      return std::nullopt;
    }
  };
  return find_tips({workload.disc_radius, workload.rays, sim::useful_threads(options.threads)},
                   {.factor = 4, .steps = 4, .most_threads = sim::useful_threads(0)}, choose, options.stop);
}

Tips tips_of(const Candidate& choice, const Workload& workload, const Valid<CostTable>& costs,
             std::span<const Technique> disabled, const model::SearchLimits& limits) {
  const auto choose = [&](const TipInputs& inputs) -> std::optional<TippedChoice> {
    try {
      const Valid<Workload> changed(changed_workload(workload, inputs));
      model::SearchLimits with_threads = limits;
      with_threads.threads = inputs.threads;
      const auto ranking = allowed_ranking(changed, costs, disabled, with_threads);
      if (ranking.empty()) return std::nullopt;
      const model::Ranked& best = ranking.front();
      const double seconds = best.time.total();
      TippedChoice there{best.candidate, best.threads, seconds, seconds};
      if (choice.technique == best.candidate.technique && !(choice == best.candidate))
        there.unchanged_seconds = model::assess(changed, choice, costs, inputs.threads).time.total();
      return there;
    } catch (const std::invalid_argument&) {  // no workload has this radius
      return std::nullopt;
    }
  };
  return find_tips({workload.disc_radius, workload.rays, limits.threads},
                   {.factor = 16, .steps = 4, .most_threads = sim::useful_threads(0)}, choose, limits.stop);
}

}  // namespace detp::validate
