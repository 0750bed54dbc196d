#include "observe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopwatch.hpp"

namespace detp::sim {
namespace {

const Effect& effect_named(std::string_view name) {
  std::string known;
  for (const Effect* effect : all_effects) {
    if (name == effect->name || name == option_name(*effect)) {
      if (effect->is_input)
        throw std::invalid_argument(
            fmt::format("the effect {} is a meaning of the input; it cannot be switched", detp::quoted(name)));
      return *effect;
    }
    if (!effect->is_input) known += fmt::format("{}{}", known.empty() ? "" : ", ", option_name(*effect));
  }
  throw std::invalid_argument(
      fmt::format("there is no effect {}; there are auto, none, all, or a list of {}", detp::quoted(name), known));
}

std::string reason_for(const EffectReport& report, const EffectSelection& selection) {
  const Threshold& threshold = report.effect->threshold;
  if (!selection.is_decided_by_evidence(*report.effect))
    return fmt::format("switched {} by --effects {}", report.on ? "on" : "off", selection.text());
  const auto text = [&](const char* passed, const char* not_passed) {
    return fmt::format("{:.4g} is {} {:.4g}", report.value, report.on ? passed : not_passed, threshold.at);
  };
  std::string reason;
  switch (threshold.side) {
    case Threshold::Side::above:
      reason = text("above", "not above");
      break;
    case Threshold::Side::below:
      reason = text("below", "not below");
      break;
    case Threshold::Side::apart:
      reason = text("apart from", "near") +
               fmt::format(" by {} than {:.4g}", report.on ? "more" : "not more", threshold.tolerance);
  }
  if (!report.on && threshold.passed(report.value))
    reason = fmt::format("{:.4g} passes the threshold ({}) by less than its standard error {:.2g}", report.value,
                         condition(threshold), report.standard_error);
  return report.is_close() ? reason + "; close to its threshold" : reason;
}

EffectReport judged(const Effect& effect, double value, double standard_error, const EffectSelection& selection) {
  EffectReport report{.effect = &effect,
                      .on = selection.is_on(effect, value, standard_error),
                      .value = value,
                      .standard_error = standard_error};
  report.decided_by_evidence = selection.is_decided_by_evidence(effect);
  report.reason = reason_for(report, selection);
  return report;
}

}  // namespace

EffectSelection::EffectSelection(std::string_view text) : automatic_(text == "auto") {
  if (automatic_ || text == "none") return;
  if (text == "all") {
    on_.assign(all_effects.begin(), all_effects.end());
    return;
  }
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    on_.push_back(&effect_named(text.substr(from, comma - from)));
    from = comma + 1;
  }
}

bool EffectSelection::is_on(const Effect& effect, double value, double standard_error) const {
  if (is_decided_by_evidence(effect))
    return effect.threshold.passed(value) && effect.threshold.distance(value) > standard_error;
  return std::find(on_.begin(), on_.end(), &effect) != on_.end();
}

std::string EffectSelection::text() const {
  if (automatic_) return "auto";
  if (on_.empty()) return "none";
  if (on_.size() == all_effects.size()) return "all";
  std::string names;
  for (const Effect* effect : on_) names += fmt::format("{}{}", names.empty() ? "" : ",", option_name(*effect));
  return names;
}

bool EffectReport::is_close() const {
  if (effect->is_input) return false;
  const Threshold& threshold = effect->threshold;
  const double near = threshold.side == Threshold::Side::apart ? 0.2 * threshold.tolerance : 0.02 * threshold.at;
  return threshold.distance(value) < std::max(2 * standard_error, near);
}

Observed observe(const Problem& problem, const SurfaceFacts& surface, const EffectSelection& selection,
                 const std::stop_token& stop, const EvidenceEffort& effort) {
  const DefaultFloatingPoint mode;
  const Stopwatch watch;
  const EffectSample sample(problem, surface, effort, stop);
  Observed observed{
      .workload = without_effects(problem), .rays = sample.rays().size(), .discs = sample.discs().discs.size()};
  for (const Effect* effect : all_effects) {
    const Stopwatch one;
    const Finding finding = effect->find(sample);
    EffectReport report = judged(*effect, finding.value, finding.standard_error, selection);
    if (report.on) finding.apply(observed.workload);
    report.seconds = one.seconds();
    observed.effects.push_back(std::move(report));
  }
  observed.seconds = watch.seconds();
  return observed;
}

Workload with_inputs_alone(const Problem& problem, const std::stop_token& stop) {
  Workload workload = without_effects(problem);
  const EffectSample sample(problem, {}, {}, stop);
  for (const Effect* effect : all_effects) {
    if (!effect->is_input) continue;
    const Finding finding = effect->find(sample);
    if (EffectSelection().is_on(*effect, finding.value, finding.standard_error)) finding.apply(workload);
  }
  return workload;
}

Workload without_effects(const Problem& problem) {
  return without_effects({problem.enclosing(), problem.centres(), problem.radii()},
                         static_cast<double>(problem.discs().size()), static_cast<double>(problem.rays().size()),
                         problem.segments());
}

Workload without_effects(const DiscSummary& discs, double samples, double rays, bool rays_end) {
  const glm::dvec3 size = discs.centres.size();
  Workload workload{.rays = rays,
                    .samples = samples,
                    .disc_radius = discs.radii.rms,
                    .sphere_radius = discs.enclosing.radius,
                    .box = {size.x, size.y, size.z},
                    .rays_end = rays_end};
  // If all samples are at one point, their box has no size. Then uses a cube with the discs' diameter as side.
  if (!(scene_side(workload) > 0)) workload.box.fill(2 * workload.disc_radius);
  return workload;
}

std::vector<EffectReport> effects_of_numbers(const Workload& workload) {
  std::vector<EffectReport> reports;
  for (const Effect* effect : all_effects) reports.push_back(judged(*effect, effect->of_numbers(workload), 0, {}));
  return reports;
}

std::string option_name(const Effect& effect) {
  std::string name(effect.name);
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string condition(const Threshold& threshold) {
  switch (threshold.side) {
    case Threshold::Side::above:
      return fmt::format("> {:.4g}", threshold.at);
    case Threshold::Side::below:
      return fmt::format("< {:.4g}", threshold.at);
    case Threshold::Side::apart:
      break;
  }
  return fmt::format("differs from {:.4g} by more than {:.4g}", threshold.at, threshold.tolerance);
}

}  // namespace detp::sim
