#include "study_workload.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/choice/choice.hpp"

namespace detp::study {

StudyWorkload::StudyWorkload(const validate::RegretWorkload& workload, Effort effort)
    : workload_(workload), job_(validate::make_regret_job(workload, 1, {})), problem_(job_.problem()) {
  if (effort == Effort::all) job_.measuring.effort = {};
  constexpr std::size_t fewest = 50;
  if (job_.discs.size() < fewest)
    throw std::invalid_argument(fmt::format("fewer than {} samples ({})", fewest, job_.discs.size()));
}

sim::Observed StudyWorkload::observe(const sim::EffectSelection& selection) const {
  return sim::observe(problem_, job_.surface, selection, {}, job_.measuring.effort);
}

sim::EffectSelection StudyWorkload::switched(const sim::Effect& effect) const {
  std::string names;
  for (const sim::EffectReport& report : automatic().effects)
    if (!report.effect->is_input && report.on != (report.effect == &effect))
      names += fmt::format("{}{}", names.empty() ? "" : ",", sim::option_name(*report.effect));
  return sim::EffectSelection(names.empty() ? "none" : names);
}

sim::Observed StudyWorkload::observe_switched(const sim::Effect& effect) const { return observe(switched(effect)); }

validate::RegretWorkload StudyWorkload::made_switched(const sim::Effect& effect) const {
  validate::RegretWorkload made = workload_;
  made.effects = switched(effect);
  return made;
}

Counts<double> StudyWorkload::count(const Candidate& candidate) const {
  return as_expected(sim::run(problem_, candidate).counts);
}

std::string StudyWorkload::row() const {
  return fmt::format("{},{},{},{:.5g},{:.0f},{:.0f}", workload_.scene, !workload_.held_out,
                     workload_.field == sim::Field::photons ? "photons" : "isotropic", job_.given.disc_radius,
                     job_.given.rays, job_.given.samples);
}

Candidate chosen_for(const Workload& workload) {
  return validate::choose({.workload = workload}, validate::built_in_unit_costs()).best().candidate;
}

std::string cell_of(const Candidate& candidate) {
  std::string text = fmt::format("{} {}", name(candidate.technique), describe(candidate));
  std::replace(text.begin(), text.end(), ',', ';');
  while (text.ends_with(' ')) text.pop_back();
  return text;
}

}  // namespace detp::study
