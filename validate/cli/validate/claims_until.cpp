#include "validate_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/validate/cli/options/number_option.hpp"
#include "detp/validate/cli/report/answer_rows.hpp"
#include "detp/validate/job/job.hpp"

namespace detp::cli {
namespace {

std::string digest_of(const validate::Experiment& experiment) {
  validate::Digest digest;
  const Workload& workload = experiment.workload;
  for (const double value : {workload.rays, workload.samples, workload.disc_radius, workload.sphere_radius,
                             workload.dimension, workload.path_length, workload.ray_density, workload.hit_ratio})
    digest.add(value);
  for (const double side : workload.box) digest.add(side);
  for (const double ratio : experiment.ratios) digest.add(ratio);
  validate::add(experiment.discs, digest);
  if (experiment.choice) validate::add(experiment.choice->rays, digest);
  return digest.text();
}

/// Null if there is none, or if it is infinite.
Json finite_json(const std::optional<double>& value) { return value ? known(*value) : Json(); }

/// The line "errors", and what is missing.
std::string until_summary(const validate::FindingsUntil& until, const validate::FindingsTarget& target) {
  std::string missing;
  std::string dark;
  std::string fixed;
  const auto add = [](std::string& list, const std::string& one) { list += (list.empty() ? "" : "; ") + one; };
  for (std::size_t i = 0; i < until.findings.size(); ++i) {
    const validate::Refinement& one = until.refinements[i];
    const std::string& id = until.findings[i].id;
    if (one.reached) continue;
    if (!one.more_lines)
      add(fixed, id);
    else if (!std::isfinite(*one.more_lines))
      add(dark, fmt::format("{} (at most {:.2g} of its lines meet anything)", id, one.share_bound.value_or(1)));
    else
      add(missing, fmt::format("{} (now {:.2g} %) about {:.2g} more lines, {:.2g} s", id, 100 * one.relative_error,
                               *one.more_lines, *one.more_seconds));
  }
  std::string text =
      fmt::format("errors    {} of {} counts are known within {:.2g} % ({:.3g} % confidence for all together)\n",
                  std::ranges::count(until.refinements, true, &validate::Refinement::reached), until.findings.size(),
                  100 * target.relative_error, 100 * target.confidence);
  if (!missing.empty()) text += "          undecided, needs: " + missing + "\n";
  if (!dark.empty()) text += "          undecided, nothing was met: " + dark + "\n";
  if (!fixed.empty()) text += "          not more accurate with more lines: " + fixed + "\n";
  return text;
}

}  // namespace

std::optional<validate::FindingsTarget> ClaimsUntilOptions::target() const {
  if (!relative_error) {
    if (confidence || least_lines || most_lines)
      throw std::invalid_argument("--confidence, --min-lines and --max-lines belong to --until-relative-error");
    return std::nullopt;
  }
  validate::FindingsTarget target{.relative_error = parse_share("--until-relative-error", *relative_error)};
  if (confidence) target.confidence = parse_share("--confidence", *confidence);
  target.least_lines = least_lines.value_or(target.least_lines);
  target.most_lines = most_lines.value_or(target.most_lines);
  check(target);
  return target;
}

validate::FindingsUntil find_until(const validate::Experiment& experiment, const validate::FindingsTarget& target,
                                   std::span<const validate::ExperimentStep> steps,
                                   const std::optional<std::filesystem::path>& checkpoint, bool resume,
                                   const sim::ReportPhase& progress, const std::stop_token& stop) {
  if (!checkpoint) return validate::findings_until(experiment, target, progress, nullptr, {}, steps);
  std::string experiments;
  for (const validate::ExperimentStep& step : steps) experiments += fmt::format(" {}", step.key);
  validate::CheckpointFile file(*checkpoint, "validate --until-relative-error",
                                {{"seed", experiment.seed},
                                 {"relative error", target.relative_error},
                                 {"confidence", target.confidence},
                                 {"least lines", target.least_lines},
                                 {"most lines", target.most_lines},
                                 {"experiments", experiments},
                                 {"digest of workload, ratios, discs and rays", digest_of(experiment)}});
  nlohmann::json saved;
  if (resume)
    if (auto state = file.read(stop)) saved = std::move(*state);
  return validate::findings_until(experiment, target, progress, &file, saved, steps);
}

Json refinement_json(const validate::FindingsUntil& until, const std::string& id) {
  const auto found = std::ranges::find(until.findings, id, &validate::Finding::id);
  const validate::Refinement& one = until.refinements.at(static_cast<std::size_t>(found - until.findings.begin()));
  return {{"relative_error", known(one.relative_error)},
          {"reached", one.reached},
          {"more_lines", finite_json(one.more_lines)},
          {"more_seconds", finite_json(one.more_seconds)},
          {"share_bound", finite_json(one.share_bound)}};
}

void add_until(const validate::FindingsUntil& until, const validate::FindingsTarget& target, Result& result) {
  result.inputs["until_relative_error"] = target.relative_error;
  result.inputs["confidence"] = target.confidence;
  result.inputs["min_lines"] = target.least_lines;
  result.inputs["max_lines"] = target.most_lines;
  const auto reached = std::ranges::count(until.refinements, true, &validate::Refinement::reached);
  if (until.stopped)
    result.stopped = sim::Progress{static_cast<std::uint64_t>(reached), until.findings.size(), "counts"};
  result.not_reached = !until.stopped && std::ranges::any_of(until.refinements, [](const validate::Refinement& one) {
    return one.more_lines.has_value();
  });
  result.text = until_summary(until, target) + result.text;
}

}  // namespace detp::cli
