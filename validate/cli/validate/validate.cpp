#include <CLI/CLI.hpp>
#include <memory>
#include <stdexcept>

#include "detp/validate/claims/validation.hpp"
#include "detp/validate/cli/command.hpp"
#include "detp/validate/cli/options/value_lists.hpp"
#include "detp/validate/cli/options/workload_options.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/cli/text/table.hpp"
#include "validate_text.hpp"

namespace detp::cli {
namespace {

struct UntilOptions {
  std::optional<std::string> relative_error;
  std::optional<std::string> confidence;
  std::optional<double> least_lines;
  std::optional<double> most_lines;

  /// Nothing if claims are judged after their usual number of lines.
  [[nodiscard]] std::optional<validate::FindingsTarget> target() const {
    if (!relative_error) {
      if (confidence || least_lines || most_lines)
        throw std::invalid_argument("--confidence, --min-lines and --max-lines belong to --until-relative-error");
      return std::nullopt;
    }
    validate::FindingsTarget target{.relative_error = parse_share("--until-relative-error", *relative_error)};
    if (confidence) target.confidence = parse_share("--confidence", *confidence);
    target.least_lines = least_lines.value_or(target.least_lines);
    target.most_lines = most_lines.value_or(target.most_lines);
    return target;
  }
};

struct ValidateOptions {
  WorkloadOptions workload;
  bool thorough = false;
  double most_samples = 1e7;
  std::optional<std::string> sweep_rows;
  UntilOptions until;
  std::vector<std::string> experiments;
  std::vector<std::string> ratios;
  std::optional<std::string> form;
  std::optional<std::string> checkpoint;
  bool resume = false;
};

/// Throws std::invalid_argument for a name of no experiment.
void check_experiments(const std::vector<std::string>& names) {
  std::vector<std::string_view> keys;
  for (const validate::ExperimentStep& step : validate::experiment_steps()) keys.push_back(step.key);
  for (const std::string& name : names) static_cast<void>(one_of("--experiments", name, keys));
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

validate::ValidateRequest validate_request(const ValidateOptions& options, const CommonOptions& common) {
  if (!options.thorough && (options.sweep_rows || options.most_samples < 1e7))
    throw std::invalid_argument("--sweep-rows and --most-samples belong to --effort thorough");
  require_count("--most-samples", options.most_samples, 1e3, 1e18);
  check_experiments(options.experiments);
  validate::ValidateRequest request{.job = options.workload.request(common, false),
                                    .experiments = options.experiments,
                                    .ratios = ratios_of(options),
                                    .until = options.until.target(),
                                    .checkpoint = options.checkpoint,
                                    .resume = options.resume,
                                    .ranks = common.ranks};
  if (options.form) request.form = choice_named<Form>(*options.form);
  if (options.thorough) request.sweep_samples = options.most_samples;
  return request;
}

Result run_validate(const ValidateOptions& options, const CommonOptions& common, const std::stop_token& stop) {
  validate::ValidateRequest request = validate_request(options, common);
  std::string scene;
  request.made = [&](const validate::Job& job) {
    note_all(common, job);
    scene = describe(job);
  };
  const ProgressLine progress(common.quiet);
  validate::ValidateAnswer answer = validate::answer(request, stop, progress.report());
  if (!common.answers()) return {};
  Result result;
  result.json = json_of(answer);
  result.text = text_of(answer, request.until ? &*request.until : nullptr, scene, common.screen());
  Table table(validate::validate_columns());
  for (const Json& row : validate::validate_rows(answer)) table.add(row);
  result.csv = table.csv();
  result.code = answer.refuted() ? ExitCode::refuted : ExitCode::done;
  result.not_reached = answer.not_reached;
  result.stopped = answer.stopped;
  if (options.sweep_rows && answer.sweep)
    validate::write_sweep_rows(*options.sweep_rows, answer.sweep->deviations, stop);
  result.inputs = std::move(answer.inputs);
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
  app->add_option("--checkpoint", options->checkpoint,
                  "keep in this file what --effort thorough or --until-relative-error has found; default: none");
  app->add_flag("--resume", options->resume, "go on from the checkpoint; default: begin anew");
  app->add_option("--sweep-rows", options->sweep_rows,
                  "thorough: write one row for each count of the sweep as CSV; default: none");
  add_count(*app, "--most-samples", options->most_samples, "thorough: leave out larger workloads; default: 1e7, all");
  return {app,
          [options](const CommonOptions& common, const std::stop_token& stop) {
            return run_validate(*options, common, stop);
          },
          true, validate::describe_validate()};
}

}  // namespace detp::cli
