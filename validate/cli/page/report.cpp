#include <fmt/format.h>

#include <numeric>
#include <stdexcept>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/files/output_file.hpp"
#include "detp/validate/accuracy/accuracy_plan.hpp"
#include "detp/validate/cli/command.hpp"
#include "detp/validate/cli/command_line.hpp"
#include "detp/validate/cli/envelope.hpp"
#include "detp/validate/cli/options/number_option.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/cli/text/table.hpp"
#include "detp/validate/picture/labels.hpp"
#include "detp/validate/report/page.hpp"
#include "report_parts.hpp"

namespace detp::cli {
namespace {

/// The report while it is made: parts so far, and what is left.
class Report {
 public:
  Report(const ReportOptions& options, bool quiet, const std::stop_token& stop)
      : options_(options), stop_(stop), progress_(quiet) {
    report_["inputs"] = {{"scene", options.scene},
                         {"rays", options.rays ? Json(*options.rays) : Json()},
                         {"disc_radius", options.radius ? Json(*options.radius) : Json()},
                         {"samples", options.samples ? Json(*options.samples) : Json()},
                         {"light", options.lights ? Json(*options.lights) : Json()},
                         {"up", options.up ? Json(*options.up) : Json()},
                         {"front_facing", options.front_facing},
                         {"target_error", options.error ? Json(*options.error) : Json()},
                         {"target_noise", options.noise   ? Json(*options.noise)
                                          : options.error ? Json()
                                                          : Json("5%")},
                         {"quick", options.quick}};
    report_["answer"] = Json::object();
    report_["warnings"] = Json::array();
    report_["parts"] = Json::array();
  }

  Json make() {
    // `scene` is short, and says how long the others will take.
    if (!add(scene_part(options_), 0)) return finished();
    const std::vector<ReportPart> parts = report_parts(options_, scale_of(validate::answer_of(report_, "scene")));
    forecast_ = clock_.seconds();
    for (const ReportPart& part : parts) forecast_ += part.forecast;
    report_["forecast_seconds"] = forecast_;
    for (const ReportPart& part : parts)
      if (!add(part, part.forecast)) break;
    return finished();
  }

 private:
  /// Returns false if a stop request ended the part.
  bool add(const ReportPart& part, double forecast) {
    Json made{{"name", part.name}, {"command", part.line()}, {"seconds", nullptr}, {"forecast_seconds", nullptr}};
    if (forecast > 0) made["forecast_seconds"] = forecast;
    show(part.name, forecast);
    const sim::Stopwatch clock;
    bool goes_on = true;
    try {
      made["answer"] = ask(part.words, stop_);
      goes_on = made["answer"]["stopped"] == false;
      for (const Json& warning : validate::list(made["answer"], "warnings")) add_warning(warning);
    } catch (const sim::Stopped&) {
      goes_on = false;
    } catch (const std::invalid_argument& error) {
      if (!part.may_fail) throw;
      made["not_made"] = error.what();
    }
    made["seconds"] = clock.seconds();
    report_["parts"].push_back(std::move(made));
    stopped_ = stopped_ || !goes_on || stop_.stop_requested();
    return !stopped_;
  }

  void add_warning(const Json& warning) {
    for (const Json& one : report_["warnings"])
      if (one == warning) return;
    report_["warnings"].push_back(warning);
  }

  void show(const std::string& name, double forecast) {
    const double now = clock_.seconds();
    const double whole = std::max(forecast_, now + forecast);
    progress_.show({name, whole > 0 ? now / whole : 0, whole > 0 ? (now + forecast) / whole : 0, 0, forecast});
  }

  Json finished() {
    report_["answer"] = report_answer(report_);
    report_["seconds"] = clock_.seconds();
    report_["stopped"] = stopped_;
    return std::move(report_);
  }

  const ReportOptions& options_;
  std::stop_token stop_;
  ProgressLine progress_;
  sim::Stopwatch clock_;
  double forecast_ = 0;
  bool stopped_ = false;
  Json report_;
};

std::string text_of(const Json& report, const std::string& path, const Screen& screen) {
  const auto seconds = validate::number(report, "seconds").value_or(0);
  std::string text =
      wrapped("answer    " + validate::words(validate::list(report, "answer"), "text"), screen.text_width(), 10);
  text += fmt::format("page      {}\n", path);
  std::string parts;
  for (const Json& part : validate::list(report, "parts"))
    parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", validate::words(part, "name"),
                         validate::seconds_label(validate::number(part, "seconds").value_or(0)));
  return text +
         wrapped(fmt::format("time      {}: {}", validate::seconds_label(seconds), parts), screen.text_width(), 10);
}

std::string csv_of(const Json& report) {
  Table table({"part", "command", "seconds", "forecast_seconds"});
  for (const Json& part : validate::list(report, "parts"))
    table.add({{"part", part["name"]},
               {"command", part["command"]},
               {"seconds", part["seconds"]},
               {"forecast_seconds", part["forecast_seconds"]}});
  return table.csv();
}

Result run_report(ReportOptions options, const CommonOptions& common, const std::stop_token& stop) {
  if (!common.output) throw std::invalid_argument("report writes a page: give -o FILE.html");
  if (options.error && options.noise) throw std::invalid_argument("give one of --target-noise and --target-error");
  if (const auto& share = options.error ? options.error : options.noise)
    validate::check({validate::AccuracyTarget::Kind::total,
                     parse_share(options.error ? "--target-error" : "--target-noise", *share)},
                    1e9);
  if (common.seed != CommonOptions{}.seed) options.common = {"--seed", std::to_string(common.seed)};
  if (common.threads != 0) options.common.insert(options.common.end(), {"--threads", std::to_string(common.threads)});
  Json report = Report(options, common.quiet, stop).make();
  Result result;
  result.inputs = std::move(report["inputs"]);
  report.erase("inputs");
  if (report["stopped"] == true) result.stopped.emplace();
  result.text = text_of(report, *common.output, common.screen());
  result.csv = csv_of(report);
  result.json = std::move(report);
  Result shown = result;
  const Json whole = envelope("report", common, sim::thread_count(common.threads), shown);
  sim::OutputFile file(*common.output, stop);
  file.write(validate::page_html(whole));
  file.commit();
  result.output_is_written = true;
  return result;
}

}  // namespace

Command report_command(CLI::App& program) {
  CLI::App* app = program.add_subcommand("report", "One page that answers, then shows: choice, accuracy, verdicts");
  app->footer(
      "Example: detp report @tree -o report.html\nExample: detp report scene.obj -o report.html --target-error 5% "
      "--quick");
  const auto options = std::make_shared<ReportOptions>();
  app->add_option("SCENE", options->scene, "a mesh (.obj, .ply) or a built-in scene")->required();
  add_count(*app, "--rays", options->rays, "how many rays, as 100k; default: 100k");
  app->add_option(
      "--disc-radius", options->radius,
      "d: a length, or a percentage of the scene's longest side; default: half the distance between samples");
  add_count(*app, "--samples", options->samples, "how many samples; default: the scene's vertices");
  app->add_option("--light", options->lights, "lights placed in the scene, as of run; default: the scene's own");
  app->add_option("--up", options->up, "which way is up, as of run; default: auto");
  app->add_flag("--front-facing", options->front_facing, "light that arrives from behind does not count");
  app->add_option("--target-error", options->error,
                  "noise and bias together, as 5%, whose cost is asked for; default: 5% noise");
  app->add_option("--target-noise", options->noise, "noise whose cost is asked for; default: 5%");
  app->add_flag("--quick", options->quick,
                "smaller map, pilots of some seconds, closed forms of one technique; default: all of it");
  return {app, [options](const CommonOptions& common, const std::stop_token& stop) {
            return run_report(*options, common, stop);
          }};
}

}  // namespace detp::cli
