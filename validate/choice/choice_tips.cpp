#include "choice_tips.hpp"

#include <algorithm>
#include <stdexcept>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/technique/piloted_discs.hpp"

namespace detp::validate {
namespace {

/// The choice, with counts of box trees that can be extrapolated.
Choice with_growth(const Choice& choice) {
  Choice found = choice;
  for (Prediction& one : found.candidates) {
    const auto* shape = std::get_if<BoxTreeParameters>(&one.candidate.parameters);
    if (one.counts_at || shape == nullptr || !choice.discs) continue;
    one.counts_at = [counts = choice.discs->counts(*shape, true)](double radius_ratio, double rays) {
      return counts.at(radius_ratio, rays);
    };
  }
  return found;
}

/// The time of the candidate in that choice; by its closed form if it is not among those that were compared.
double seconds_in(const Choice& there, const Candidate& candidate, const Workload& workload, const CostTable& costs,
                  int threads) {
  for (const Prediction& one : there.candidates)
    if (one.candidate == candidate) return one.seconds();
  if (there.rigor != Rigor::estimate || candidate.technique != there.best().candidate.technique)
    return there.best().seconds();
  return model::assess(workload, candidate, costs, threads).seconds();
}

ChoiceThere choice_there(const Choice& choice, double unchanged_seconds) {
  ChoiceThere there{choice.best(), unchanged_seconds, choice.unexamined};
  if (choice.rigor == Rigor::estimate) return there;
  for (const Prediction& one : choice.candidates)
    if (one.source == Source::closed_form && one.candidate.technique != choice.best().candidate.technique)
      there.not_ruled_out.push_back(one.candidate.technique);
  return there;
}

}  // namespace

Tips tips_of(const Choice& choice, const Question& question, const Valid<CostTable>& costs) {
  const Workload& workload = question.workload.value();
  const Candidate present = choice.best().candidate;
  const Choice counted = with_growth(choice);
  const CostTable priced = costs_for(question, costs);
  const auto choose = [&](const TipInputs& inputs) -> std::optional<ChoiceThere> {
    try {
      Question changed = question;
      changed.threads = inputs.threads;
      const Choice there =
          choose_again(counted, changed, inputs.disc_radius / workload.disc_radius, inputs.rays, costs);
      Workload with_inputs = with_disc_radius(workload, inputs.disc_radius);
      with_inputs.rays = inputs.rays;
      return choice_there(there, seconds_in(there, present, with_inputs, priced, inputs.threads));
    } catch (const std::invalid_argument&) {  // no workload has this radius
      return std::nullopt;
    } catch (const sim::Stopped&) {
      return std::nullopt;
    }
  };
  return find_tips(
      {workload.disc_radius, question.ray_count.value_or(workload.rays), sim::useful_threads(question.threads)},
      {.factor = choice.rigor == Rigor::estimate ? 16.0 : 4.0, .steps = 4, .most_threads = sim::useful_threads(0)},
      choose, question.stop);
}

}  // namespace detp::validate
