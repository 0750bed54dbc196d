#include "effects_table.hpp"

#include <fmt/format.h>

#include "detp/model/rank/predict.hpp"

namespace detp::study {
namespace {

/// Empty if the divisor is 0.
std::string ratio_text(double value, double divisor) {
  return divisor > 0 ? fmt::format("{:.4g}", value / divisor) : "";
}

/// What switching an effect by hand changes.
struct Switched {
  std::string ratios = ",,,";  ///< of predicted tests and hits, and of counted tests and hits if the rays change
  std::string choice = {};
  double tests = 1;
  double hits = 1;
};

Switched with_switched(const StudyWorkload& workload, const sim::Effect& effect, const Counts<double>& predicted,
                       const Counts<double>& counted) {
  const auto text = [&](const Workload& changed, const std::string& counts) {
    const Counts<double> now = model::predict(changed, usual_tree());
    return Switched{fmt::format("{},{},{}", ratio_text(tests_of(now), tests_of(predicted)),
                                ratio_text(now.hits, predicted.hits), counts),
                    cell_of(chosen_for(changed)), tests_of(now) / tests_of(predicted), now.hits / predicted.hits};
  };
  const bool changes_rays = &effect == &sim::concave_surfaces && workload.workload().field == sim::Field::photons;
  if (!changes_rays) return text(workload.observe_switched(effect).workload, ",");
  const StudyWorkload made(workload.made_switched(effect), StudyWorkload::Effort::all);
  const Counts<double> now = made.count(usual_tree());
  return text(made.automatic().workload,
              ratio_text(tests_of(now), tests_of(counted)) + "," + ratio_text(now.hits, counted.hits));
}

}  // namespace

void EffectsTable::add(const StudyWorkload& workload) {
  const sim::Observed& automatic = workload.automatic();
  const Counts<double> predicted = model::predict(automatic.workload, usual_tree());
  const Counts<double> without = model::predict(workload.observe(sim::EffectSelection("none")).workload, usual_tree());
  const Counts<double> counted = workload.count(usual_tree());
  Half& half = workload.workload().held_out ? held_out_ : tuned_;
  const int field = workload.workload().field == sim::Field::photons ? 1 : 0;
  half.tests[field].add(tests_of(predicted), tests_of(counted));
  half.tests_without[field].add(tests_of(without), tests_of(counted));
  if (counted.hits >= 100) {
    half.hits[field].add(predicted.hits, counted.hits);
    half.hits_without[field].add(without.hits, counted.hits);
  }
  const std::string choice = cell_of(chosen_for(automatic.workload));
  for (const sim::EffectReport& report : automatic.effects) {
    const sim::Effect& effect = *report.effect;
    const Switched switched = effect.is_input ? Switched{} : with_switched(workload, effect, predicted, counted);
    if (!effect.is_input) changes_.add(report, switched.tests, switched.hits, switched.choice != choice);
    csv_ += fmt::format("{},{},{:.4g},{:.2g},{:.4g},{:.4g},{},{},{:.3g},{},{},{},{},{}\n", workload.row(), effect.name,
                        report.value, report.standard_error, effect.threshold.at, effect.threshold.tolerance, report.on,
                        report.is_close(), report.seconds, switched.ratios,
                        ratio_text(tests_of(predicted), tests_of(counted)), ratio_text(predicted.hits, counted.hits),
                        choice, switched.choice);
  }
}

std::string EffectsTable::summary() const {
  std::string text =
      changes_.table() +
      "\n| | workloads | median | worst | within 25 % | within a factor of 2 |\n|---|---|---|---|---|---|\n";
  for (const bool tuned : {true, false}) {
    const Half& half = tuned ? tuned_ : held_out_;
    for (const int field : {0, 1}) {
      const std::string where =
          fmt::format("{}, {}", field == 1 ? "photon paths" : "isotropic lines", tuned ? "tuned" : "held out");
      text += half.tests_without[field].row(fmt::format("tests, {}, no effects", where));
      text += half.tests[field].row(fmt::format("tests, {}, auto", where));
      text += half.hits_without[field].row(fmt::format("hits, {}, no effects", where));
      text += half.hits[field].row(fmt::format("hits, {}, auto", where));
    }
  }
  return text;
}

}  // namespace detp::study
