#include "detp/sim/technique/technique.hpp"
#include "detp/validate/claims/experiments.hpp"
#include "detp/validate/cli/command.hpp"
#include "detp/validate/cli/options/number_option.hpp"
#include "detp/validate/cli/options/value_lists.hpp"
#include "detp/validate/cli/options/workload_options.hpp"
#include "detp/validate/cli/report/answer_rows.hpp"
#include "detp/validate/cli/report/effects_report.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/cli/text/table.hpp"
#include "validate_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace detp::cli {
namespace {

using validate::Claim;
using validate::Verdict;

constexpr double default_lines = 1e6;
constexpr double share_of_claims = 0.03;  ///< of the time of a thorough validation

struct ValidateOptions {
  WorkloadOptions workload;
  bool thorough = false;
  double most_samples = 1e7;
  validate::SweepOptions sweep;
  std::optional<std::string> sweep_rows;
  ClaimsUntilOptions until;
  std::vector<std::string> experiments;
  std::vector<std::string> ratios;
  std::optional<std::string> form;
};

/// Those that the option names, in their usual order; all without it. Throws std::invalid_argument for an unknown name.
std::vector<validate::ExperimentStep> steps_of(const ValidateOptions& options) {
  const auto all = validate::experiment_steps();
  std::vector<std::string_view> keys;
  for (const validate::ExperimentStep& step : all) keys.push_back(step.key);
  for (const std::string& text : options.experiments) static_cast<void>(one_of("--experiments", text, keys));
  std::vector<validate::ExperimentStep> steps;
  for (const validate::ExperimentStep& step : all)
    if (options.experiments.empty() || std::ranges::find(options.experiments, step.key) != options.experiments.end())
      steps.push_back(step);
  return steps;
}

/// Q of --ratio, each once. Throws std::invalid_argument unless each is between 0 and 1.
std::vector<double> ratios_of(const ValidateOptions& options) {
  std::vector<double> ratios;
  for (const std::string& list : options.ratios)
    for (const std::string& one : values_of("--ratio", list)) {
      double ratio = 0;
      read_value("--ratio", one, ratio);
      if (!(ratio > 0 && ratio < 1))
        throw std::invalid_argument(fmt::format("--ratio must be between 0 and 1 (got {})", one));
      if (std::ranges::find(ratios, ratio) == ratios.end()) ratios.push_back(ratio);
    }
  return ratios;
}

/// Both forms are judged; those that --form does not name are not shown.
std::vector<Claim> shown_of(const std::vector<Claim>& claims, const std::optional<std::string>& form) {
  std::vector<Claim> shown;
  std::ranges::copy_if(claims, std::back_inserter(shown),
                       [&](const Claim& claim) { return !form || name(claim.form) == *form; });
  return shown;
}

void add_effects(const std::vector<sim::EffectReport>& effects, Result& result) {
  result.json["effects"] = to_json(effects);
  result.text += effects_line(effects);
}

validate::Experiment uniform_experiment(validate::JobRequest request, const std::stop_token& stop, Result& result) {
  if (request.front_facing || request.field.value_or(sim::Field::isotropic) != sim::Field::isotropic)
    throw std::invalid_argument("--front-facing and --field photons take a scene or --discs; numbers alone mean lines");
  if (!request.rays) request.rays = default_lines;
  if (!request.samples) request.samples = 20'000;
  if (!request.disc_radius) request.disc_radius = validate::Length{0.02};
  if (!request.sphere_radius && !request.scene_side) request.scene_side = 2;
  validate::Experiment experiment{.workload = validate::workload_of_numbers(request), .discs = {}, .stop = stop};
  if (experiment.workload.samples > 1e7)
    throw std::length_error("validate draws 32 sets of samples; at most 1e7 samples are allowed");
  result.inputs = numbers_json(experiment.workload);
  result.inputs["samples_are"] = "uniform";
  add_effects(sim::effects_of_numbers(experiment.workload), result);
  return experiment;
}

/// The workload with isotropic lines instead of its rays.
Workload with_lines(Workload workload, double lines) {
  workload.rays = lines;
  workload.rays_end = workload.front_facing = false;
  workload.path_length = 0;
  workload.ray_density = workload.hit_ratio = 1;
  return workload;
}

/// `choice` has the workload and rays of `choose` with the same options. The other claims are about isotropic lines: as
/// many as the requested rays, or default_lines.
validate::Experiment scene_experiment(const validate::JobRequest& request, const CommonOptions& common,
                                      const std::stop_token& stop, Result& result) {
  validate::Job job = validate::make_job(request, stop);
  note_all(common, job);
  result.json["warnings"] = job.all_said();
  result.json.update(ledgers_json(job));
  result.inputs = to_json(job, request);
  result.text = describe(job);
  add_effects(job.observed().effects, result);
  validate::Experiment experiment{
      .workload = with_lines(job.workload(), request.rays.value_or(default_lines)), .discs = {}, .stop = stop};
  experiment.choice = {job.workload(), std::move(job.rays), effects_on(job.observed().effects)};
  experiment.discs = std::move(job.discs);
  result.inputs["lines"] = whole(experiment.workload.rays);
  return experiment;
}

validate::Experiment make_experiment(const validate::JobRequest& request, const std::vector<double>& ratios,
                                     const CommonOptions& common, const std::stop_token& stop, Result& result) {
  validate::Experiment experiment = request.numbers_alone() ? uniform_experiment(request, stop, result)
                                                            : scene_experiment(request, common, stop, result);
  experiment.seed = request.seed;
  experiment.ranks = common.ranks;
  if (!ratios.empty()) experiment.ratios = ratios;
  result.inputs["ratio"] = experiment.ratios;
  result.inputs["seed"] = request.seed;
  return experiment;
}

Json claim_json(const Claim& claim, const Claims& claims) {
  return {{"id", claim.id},
          {"quantity", claim.quantity},
          {"technique", claim.technique.empty() ? Json() : Json(claim.technique)},
          {"parameters", claim.parameters.empty() ? Json() : Json(claim.parameters)},
          {"form", name(claim.form)},
          {"source", claim.source},
          {"predicted", known(claim.predicted)},
          {"observed", known(claim.observed.mean)},
          {"standard_error", known(claim.observed.standard_error)},
          {"relative_difference", known(claim.relative_difference)},
          {"tolerance", claim.tolerance},
          {"detectable", known(claim.detectable)},
          {"verdict", name(claim.verdict)},
          {"documented", is_documented(claim, claims)},
          {"control",
           {{"offset", known(claim.control_offset)},
            {"predicted", known(claim.control)},
            {"verdict", control_name(claim.control_verdict)}}},
          {"lines", claim.lines},
          {"seconds", claim.seconds}};
}

std::string known_text(double number, const char* shape) {
  return std::isfinite(number) ? fmt::format(fmt::runtime(shape), number) : "?";
}

Style style_of(Verdict verdict) {
  return verdict == Verdict::agrees ? Style::good : verdict == Verdict::refuted ? Style::bad : Style::doubtful;
}

std::string to_text(const std::vector<Claim>& shown, const std::vector<Claim>& claims, const Screen& screen) {
  TextTable table({{.head = "claim", .align = Align::left},
                   {.head = "predicted"},
                   {.head = "observed"},
                   {.head = "±", .align = Align::left, .spare = 2},
                   {.head = "differs"},
                   {.head = "within", .spare = 3},
                   {.head = "detects", .spare = 1},
                   {.head = "verdict", .align = Align::left},
                   {.head = "control", .align = Align::left, .spare = 4}});
  for (const Claim& claim : shown)
    table.add({{claim.id},
               {known_text(claim.predicted, "{:.5g}")},
               {known_text(claim.observed.mean, "{:.5g}")},
               {known_text(claim.observed.standard_error, "{:.1g}")},
               {known_text(100 * claim.relative_difference, "{:+.2f}%")},
               {fmt::format("{:.2g}%", 100 * claim.tolerance)},
               {known_text(100 * claim.detectable, "{:.2g}%")},
               is_documented(claim, claims) ? TextCell{"refuted, as documented"}
                                            : TextCell{std::string(name(claim.verdict)), style_of(claim.verdict)},
               {std::string(control_name(claim.control_verdict)),
                claim.control_verdict == Verdict::refuted ? Style::plain : Style::doubtful}});
  return table.text(screen) +
         legend(screen,
                "±: one standard error of what was observed. differs: observed over predicted, less 1. within: a "
                "difference that still counts as agreement. detects: the smallest error of the formula that would have "
                "been refuted. control: whether the formula made wrong by just that much is caught (refuted). "
                "published: the paper's formula, corrected: ours. As documented: the corrected form predicts another "
                "number, and its header says what is wrong in the published one.");
}

std::string quantities(const std::vector<Claim>& claims, const Screen& screen) {
  std::vector<std::pair<std::string, std::string>> rows;
  std::size_t width = 0;
  for (const Claim& claim : claims) {
    const std::string stem = claim.id.substr(0, claim.id.rfind('.'));
    if (!rows.empty() && rows.back().first == stem) continue;
    rows.emplace_back(stem, claim.quantity);
    width = std::max(width, stem.size());
  }
  std::string text = "\n";
  for (const auto& [stem, quantity] : rows)
    text += wrapped(fmt::format("{:<{}}  {}", stem, width, quantity), screen.text_width(), width + 2);
  return text;
}

Table table_of(const std::vector<Claim>& shown, const std::vector<Claim>& claims, const validate::FindingsUntil& until,
               const Result& result) {
  Table table(workload_columns() +
              Columns{"id",
                      "quantity",
                      "form",
                      "source",
                      "predicted",
                      "observed",
                      "standard_error",
                      "relative_difference",
                      "tolerance",
                      "detectable",
                      "verdict",
                      "documented",
                      "control_offset",
                      "control_predicted",
                      "control_verdict",
                      "lines",
                      "seconds",
                      "relative_error",
                      "reached",
                      "more_lines",
                      "more_seconds",
                      "share_bound"} +
              effect_columns() + sweep_columns());
  for (const Claim& claim : shown) {
    Json row = workload_cells(result.inputs);
    row.update(effect_cells(result.json["effects"]));
    row.update(claim_json(claim, claims));
    row["control_offset"] = known(claim.control_offset);
    row["control_predicted"] = known(claim.control);
    row["control_verdict"] = control_name(claim.control_verdict);
    row.erase("control");
    if (!until.refinements.empty()) row.update(refinement_json(until, stem(claim)));
    table.add(row);
  }
  return table;
}

void check_effort(const ValidateOptions& options, const validate::JobRequest& request) {
  if (!options.thorough && (options.sweep_rows || options.most_samples < 1e7))
    throw std::invalid_argument("--sweep-rows and --most-samples belong to --effort thorough");
  const bool until = options.until.relative_error.has_value();
  if (options.thorough && until)
    throw std::invalid_argument("give one of --effort thorough and --until-relative-error");
  if (!options.thorough && !until && (options.sweep.checkpoint || options.sweep.resume))
    throw std::invalid_argument("--checkpoint and --resume belong to --effort thorough and to --until-relative-error");
  if (options.thorough && !request.numbers_alone())
    throw std::invalid_argument("--effort thorough has workloads of its own; it takes no scene");
  require_count("--most-samples", options.most_samples, 1e3, 1e18);
}

std::vector<validate::SweepPoint> points_of(const ValidateOptions& options) {
  std::vector<validate::SweepPoint> points = validate::sweep_points();
  std::erase_if(points, [&](const validate::SweepPoint& point) { return point.samples > options.most_samples; });
  return points;
}

validate::SweepOptions sweep_options(const ValidateOptions& options, const CommonOptions& common,
                                     const std::stop_token& stop) {
  validate::SweepOptions sweep = options.sweep;
  sweep.seed = common.seed;
  sweep.stop = stop;
  return sweep;
}

void sweep(const ValidateOptions& options, const CommonOptions& common, const std::stop_token& stop,
           const ProgressLine& progress, Table& table, Result& result) {
  validate::SweepOptions sweep = sweep_options(options, common, stop);
  sweep.progress = sim::part_of(progress.report(), share_of_claims, 1);
  const validate::SweepResult measured = validate::run_sweep(points_of(options), sweep);
  if (options.sweep_rows) write_sweep_rows(*options.sweep_rows, measured.deviations, stop);
  report_sweep(measured, common.screen(), table, result);
}

Result run_validate(const ValidateOptions& options, const CommonOptions& common, const std::stop_token& stop) {
  check_effort(options, options.workload.request(common, false));
  static_cast<void>(options.until.target());
  const std::vector<validate::ExperimentStep> steps = steps_of(options);
  const std::vector<double> ratios = ratios_of(options);
  if (common.answers() && options.thorough)
    validate::check_checkpoint(points_of(options), sweep_options(options, common, stop));
  const ProgressLine progress(common.quiet);
  Result result;
  const validate::Experiment experiment =
      make_experiment(options.workload.request(common, false), ratios, common, stop, result);
  if (!common.answers()) {
    validate::serve_findings(experiment, steps);
    return {};
  }
  sim::Progress done;
  const auto target = options.until.target();
  const auto report = sim::part_of(progress.report(), 0, options.thorough ? share_of_claims : 1);
  validate::FindingsUntil until;
  if (target)
    until = find_until(experiment, *target, steps, options.sweep.checkpoint, options.sweep.resume, report, stop);
  else
    until.findings = validate::all_findings(experiment, report, &done, steps);
  const std::vector<Claim> claims = validate::judge_all(until.findings);
  const std::vector<Claim> shown = shown_of(claims, options.form);
  result.inputs["form"] = options.form ? Json(*options.form) : Json();
  result.json["summary"] = claim_summary_json(claims);
  result.json["claims"] = Json::array();
  for (const Claim& claim : shown) {
    result.json["claims"].push_back(claim_json(claim, claims));
    if (target) result.json["claims"].back().update(refinement_json(until, stem(claim)));
  }
  if (done.done < done.of) result.stopped = done;
  if (target) {
    add_until(until, *target, result);
  }
  const Screen screen = common.screen();
  result.text = (claims.empty() ? "answer    no claim was judged\n" : summary_text(claims, screen)) + "\n" +
                wrapped(result.text, screen.text_width(), 10) +
                (shown.empty() ? "" : "\n" + to_text(shown, claims, screen) + quantities(shown, screen));
  Table table = table_of(shown, claims, until, result);
  if (options.thorough && !result.stopped) sweep(options, common, stop, progress, table, result);
  result.csv = table.csv();
  result.code = code_of(claims);
  return result;
}

}  // namespace

Command validate_command(CLI::App& program) {
  CLI::App* app = program.add_subcommand("validate", "Each formula against what simulation counts, with a verdict");
  app->footer("Example: detp validate --samples 20000 --disc-radius 0.02 --scene-side 2");
  const auto options = std::make_shared<ValidateOptions>();
  options->workload.add_to(*app);
  for (const auto& [option, value] : {std::pair{"--rays", "how many rays, as 100k; default: 1M lines"},
                                      {"--samples", "how many samples; default: the scene's vertices, else 20000"},
                                      {"--disc-radius", "d; default: half the distance between samples, else 0.02"},
                                      {"--scene-side", "s, of a workload in numbers; default: 2"}})
    app->get_option(option)->description(value);
  app->add_option_function<std::string>(
         "--effort", [options](const std::string& effort) { options->thorough = effort == "thorough"; },
         "default, or thorough: also every formula over its whole range, some 40 minutes; default: default")
      ->check(CLI::IsMember({"default", "thorough"}));
  app->add_option(
         "--experiments", options->experiments,
         "a list of choice, effects, lines, sphere-cache, hierarchies, index, errors; choice and effects take a scene; "
         "default: all")
      ->delimiter(',');
  app->add_option("--ratio", options->ratios,
                  "Q of sphere caches: a list or a range, as 0.65 or 0.3:0.9:0.1; default: 0.3,0.5,0.65,0.8")
      ->delimiter(',');
  app->add_option("--form", options->form,
                  "show published or corrected formulas alone (both are judged); default: both")
      ->check(CLI::IsMember({"published", "corrected"}));
  app->add_option("--until-relative-error", options->until.relative_error,
                  "count until each observed value is known so well, as 1%; default: the usual number of lines");
  app->add_option("--confidence", options->until.confidence, "of all these errors together; default: 95%");
  add_count(*app, "--min-lines", options->until.least_lines, "of each claim, as 1M; default: what the error needs");
  add_count(*app, "--max-lines", options->until.most_lines, "of each claim; default: 1e10");
  app->add_option("--checkpoint", options->sweep.checkpoint,
                  "keep in this file what --effort thorough or --until-relative-error has found; default: none");
  app->add_flag("--resume", options->sweep.resume, "go on from the checkpoint; default: begin anew");
  app->add_option("--sweep-rows", options->sweep_rows,
                  "thorough: write one row for each count of the sweep as CSV; default: none");
  add_count(*app, "--most-samples", options->most_samples, "thorough: leave out larger workloads; default: 1e7, all");
  return {app,
          [options](const CommonOptions& common, const std::stop_token& stop) {
            return run_validate(*options, common, stop);
          },
          true};
}

}  // namespace detp::cli
