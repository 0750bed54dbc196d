#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/validate/accuracy/accuracy_answer.hpp"
#include "detp/validate/cli/command.hpp"
#include "detp/validate/cli/options/candidate_options.hpp"
#include "detp/validate/cli/options/number_option.hpp"
#include "detp/validate/cli/options/value_lists.hpp"
#include "detp/validate/cli/options/workload_options.hpp"
#include "detp/validate/cli/text/messages.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/cli/text/table.hpp"
#include "detp/validate/cli/text/words.hpp"

namespace detp::cli {
namespace {

using validate::AccuracyAnswer;
using validate::AccuracyPoint;
using validate::AccuracyTarget;
using validate::percent;

/// The request, and options that have to be read.
struct AccuracyOptions {
  validate::AccuracyRequest request = {.scene = {.name = {}, .samples = {}}};
  std::optional<std::string> noise;
  std::optional<std::string> error;
  std::optional<double> seconds;
  std::optional<double> samples;
  std::vector<std::string> estimators;
  std::optional<std::string> lights;
  std::optional<std::string> crease;
  std::optional<std::string> up;
  std::optional<std::string> seeds;
  std::vector<std::string> axes;
  std::string effort = "default";
};

AccuracyTarget target_of(const AccuracyOptions& options) {
  const int given = (options.noise ? 1 : 0) + (options.error ? 1 : 0) + (options.seconds ? 1 : 0);
  if (given > 1) throw std::invalid_argument("give one of --target-noise, --target-error and --time-budget");
  using Kind = AccuracyTarget::Kind;
  if (options.error) return {Kind::total, parse_share("--target-error", *options.error)};
  if (options.seconds) return {Kind::seconds, *options.seconds};
  return options.noise ? AccuracyTarget{Kind::noise, parse_share("--target-noise", *options.noise)} : AccuracyTarget{};
}

/// What a command that repeats a point has after its options.
std::string repeated_options(const AccuracyOptions& options) {
  std::string text;
  if (options.samples) text += fmt::format(" --samples {:.9g}", *options.samples);
  if (options.lights) text += " --light " + *options.lights;
  if (options.up) text += " --up " + *options.up;
  if (options.crease) text += " --crease " + *options.crease;
  if (options.request.front_facing) text += " --front-facing";
  if (options.request.discs) text += " --discs " + shell_word(*options.request.discs);
  return text;
}

/// The place of a name among all.
template <class Named>
Named named(const std::string& option, const std::string& text, const auto& names) {
  const std::string word = one_of(option, text, {names.begin(), names.end()});
  return static_cast<Named>(std::ranges::find(names, word) - names.begin());
}

validate::AccuracyRequest request_of(const AccuracyOptions& options, const CommonOptions& common) {
  validate::AccuracyRequest request = options.request;
  request.target = target_of(options);
  request.effort = named<validate::PlanningEffort>("--effort", options.effort, validate::planning_efforts);
  request.scene.seed = common.seed;
  request.threads = common.threads;
  request.ranks = common.ranks;
  request.command = "detp run " + shell_word(request.scene.name);
  request.command_end = repeated_options(options);
  if (options.seeds) {
    const SeedRange seeds = parse_seeds("--seeds", *options.seeds);
    request.seeds = {seeds.first, seeds.last};
  }
  for (const std::string& axis : options.axes)
    request.axes.push_back(named<validate::AccuracyAxis>("--axis", axis, validate::accuracy_axes));
  require_count("--rays", request.most_rays, 1000, 1e12);
  if (options.samples) {
    require_count("--samples", *options.samples, 1, 1e9);
    request.scene.samples = static_cast<std::size_t>(*options.samples);
  }
  if (options.lights) request.scene.lights = parse_lights(*options.lights);
  if (options.up) request.scene.up = parse_up(*options.up);
  if (options.crease) request.crease = parse_crease(*options.crease);
  for (const std::string& text : options.estimators) request.estimators.push_back(parse_estimator(text));
  return request;
}

/// A table for each axis.
std::string axes_text(const AccuracyAnswer& answer, const Screen& screen) {
  std::string text;
  for (std::size_t i = 0; i < answer.axes.size();) {
    const std::string axis = answer.axes[i].axis;
    TextTable table({{.head = axis, .align = Align::left},
                     {.head = "error of", .align = Align::left},
                     {.head = "error"},
                     {.head = "from"},
                     {.head = "to"},
                     {.head = "seconds"},
                     {.head = "1/(error² s)"}});
    for (; i < answer.axes.size() && answer.axes[i].axis == axis; ++i) {
      const validate::AxisPoint& point = answer.axes[i];
      table.add({{point.setting},
                 {point.quantity},
                 {percent(point.error)},
                 {point.interval ? percent(point.interval->low) : ""},
                 {point.interval ? percent(point.interval->high) : ""},
                 {fmt::format("{:.2g}", point.seconds)},
                 {point.error > 0 ? fmt::format("{:.2g}", point.merit()) : ""}});
    }
    text += table.text(screen) + "\n";
  }
  return text;
}

std::string to_text(const AccuracyAnswer& answer, const Screen& screen) {
  std::string text = wrapped("answer    " + answer_words(answer), screen.text_width(), 10);
  text += wrapped(
      "          " + fmt::format("In {:.2g} s, twice the time: {} total ({} noise, bias {}): {}. With the answer's "
                                 "setting, the total falls as the time to the power {:.2f} ({:.2f} to {:.2f}).",
                                 answer.in_time.seconds, percent(answer.in_time.total.value),
                                 percent(answer.in_time.noise.value), bias_words(answer.in_time),
                                 way_words(answer, answer.in_time), answer.plan.answer.slope.value,
                                 answer.plan.answer.slope.low, answer.plan.answer.slope.high),
      screen.text_width(), 10);
  text += "command   " + command_of(answer, answer.plan.answer) + "\n";  // one line, to be pasted
  text += wrapped("estimator " + validate::rivals_words(answer), screen.text_width(), 10);
  if (!answer.reruns.empty()) text += wrapped("runs      " + validate::reruns_words(answer), screen.text_width(), 10);
  text += "\n";
  TextTable table({{.head = "total"},
                   {.head = "noise"},
                   {.head = "bias"},
                   {.head = "pieces (paths)"},
                   {.head = "setting", .align = Align::left},
                   {.head = "estimator", .align = Align::left},
                   {.head = "seconds"},
                   {.head = "", .align = Align::left}});
  const auto add = [&](const AccuracyPoint& point, const std::string& remark) {
    table.add({{percent(point.total.value)},
               {percent(point.noise.value)},
               {point.bias.low > 0    ? percent(point.bias.value)
                : point.bias.high > 0 ? "< " + percent(point.bias.high)
                                      : "0"},
               {fmt::format("{:.2g}", point.rays) + (point.gathers() ? " a sample" : "")},
               {setting_words(answer, point)},
               {std::string(name(point.estimator))},
               {fmt::format("{:.2g}", point.seconds)},
               {remark}});
  };
  constexpr std::size_t rows_shown = 7;
  bool answered = false;
  for (const AccuracyPoint& point : points_around_answer(answer.plan, rows_shown)) {
    if (!answered && point.seconds >= answer.plan.answer.seconds) {
      add(answer.plan.answer, "<- answer");
      answered = true;
    }
    add(point, "");
  }
  if (!answered) add(answer.plan.answer, "<- answer");
  text += table.text(screen) + "\n" + axes_text(answer, screen);
  text +=
      wrapped(fmt::format("noise, bias, total: root mean square over {}, relative to the root mean square irradiance. "
                          "Seconds: wall clock, tracing included. Bias: {}",
                          "the samples by area", validate::judge_words(answer)),
              screen.text_width(), 0);
  return text + fmt::format("planning  {:.2g} s: a pilot of {:.2g} pieces{}\n", answer.planning_seconds,
                            answer.pilot.rays, answer.check ? ", one check" : "");
}

Result run_accuracy(const AccuracyOptions& options, const CommonOptions& common, const std::stop_token& stop) {
  const validate::AccuracyRequest request = request_of(options, common);
  const ProgressLine progress(common.quiet);
  const AccuracyAnswer answer =
      validate::answer(request, stop, progress.report(), [&](const std::string& text) { note(common, text); });
  if (!common.answers()) return {};
  Table table(validate::accuracy_columns());
  for (const Json& row : validate::accuracy_rows(answer)) table.add(row);
  Result result;
  result.inputs = inputs_json(answer);
  result.json = to_json(answer);
  result.text = to_text(answer, common.screen());
  result.csv = table.csv();
  result.stopped = answer.stopped;
  result.not_reached = !answer.plan.reached;
  return result;
}

}  // namespace

Command accuracy_command(CLI::App& program) {
  CLI::App* app =
      program.add_subcommand("accuracy", "What accuracy costs in time: rays, setting and estimator for an error");
  app->footer("Example: detp accuracy @cornell --target-noise 5%\nExample: detp accuracy @cornell --time-budget 2");
  const auto options = std::make_shared<AccuracyOptions>();
  app->add_option("SCENE", options->request.scene.name, "a mesh or a built-in scene with lights")->required();
  app->add_option("--target-noise", options->noise,
                  "noise to reach, as 5% or 0.05; the setting is the largest whose bias is below; default: 5%");
  app->add_option("--target-error", options->error, "noise and bias together to reach, as 5% or 0.05");
  add_number(*app, "--time-budget", options->seconds,
             "seconds that a run may take, tracing included: the most accurate");
  app->add_option("--estimators", options->estimators,
                  "a list of disc, variable-radius, nearest, area-corrected, triangle-hits, gather; default: all")
      ->delimiter(',');
  add_count(*app, "--rays", options->request.most_rays, "at most so many pieces of photon paths, as 10M; default: 1e9");
  add_count(*app, "--samples", options->samples, "how many samples; default: the scene's vertices");
  app->add_option(
      "--discs", options->request.discs,
      "the discs in question, from a CSV, PLY, NPY or NPZ file; default: one at each of the scene's samples");
  app->add_option(
      "--disc-radius", options->request.disc_radius,
      "radii from half to four times this one are tried (a length, or a percentage); default: from a quarter "
      "to twice the mean edge of the mesh");
  add_face_names(*app, options->request.faces);
  app->add_option("--light", options->lights, "lights placed in the scene, as of run");
  app->add_option("--up", options->up, "which way is up, as of run");
  app->add_option("--crease", options->crease, "angle from which edges are sharp, as of run");
  app->add_option("--reference", options->request.reference,
                  "the file of the irradiance to compare with; it is made if there is none (up to a minute); "
                  "default: some backward paths");
  app->add_option("--seeds", options->seeds, "runs the answer again with each of these seeds, as 1:100; default: not");
  app->add_option(
         "--axis", options->axes,
         "what accuracy costs elsewhere, too: simulation (a hit probability by several ways to sample lines), model "
         "(what choosing knows at each rigor), arithmetic (float, double, exact); default: estimator alone")
      ->delimiter(',');
  app->add_option(
         "--effort", options->effort,
         "how long planning may take, until the bias is known to a fifth of the target: quick: 0.5 s; default: that or "
         "0.3 times the answer; thorough: 20 s or twenty times the answer; default: default")
      ->check(CLI::IsMember({"quick", "default", "thorough"}));
  app->add_flag("--check", options->request.check,
                "run the answer once; its noise is added to what is known; default: not");
  app->add_flag("--front-facing", options->request.front_facing, "light that arrives from behind does not count");
  app->add_option(
      "--checkpoint", options->request.checkpoint,
      "keep in this file the pilots and the runs of --seeds, so that the command can be killed; default: none");
  app->add_flag("--resume", options->request.resume, "go on from the checkpoint; default: begin anew");
  return {app,
          [options](const CommonOptions& common, const std::stop_token& stop) {
            return run_accuracy(*options, common, stop);
          },
          true, validate::describe_accuracy()};
}

}  // namespace detp::cli
