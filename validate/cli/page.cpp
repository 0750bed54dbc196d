#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

#include "command.hpp"
#include "command_line.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/files/file_error.hpp"
#include "detp/sim/files/output_file.hpp"
#include "detp/validate/accuracy/accuracy_plan.hpp"
#include "detp/validate/cli/options/number_option.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/cli/text/table.hpp"
#include "detp/validate/picture/labels.hpp"
#include "detp/validate/report/report.hpp"
#include "envelope.hpp"

namespace detp::cli {
namespace {

void check_target(const validate::ReportRequest& request) {
  if (request.target_error && request.target_noise)
    throw std::invalid_argument("give one of --target-noise and --target-error");
  if (const auto& share = request.target_error ? request.target_error : request.target_noise)
    validate::check({validate::AccuracyTarget::Kind::total,
                     parse_share(request.target_error ? "--target-error" : "--target-noise", *share)},
                    1e9);
}

std::string report_text(const Json& report, const std::string& path, const Screen& screen) {
  std::string parts;
  for (const Json& part : report["parts"])
    parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", part["name"].get<std::string>(),
                         validate::seconds_label(part["seconds"]));
  return wrapped("answer    " + report["answer"]["text"].get<std::string>(), screen.text_width(), 10) +
         fmt::format("page      {}\n", path) +
         wrapped(fmt::format("time      {}: {}", validate::seconds_label(report["seconds"]), parts),
                 screen.text_width(), 10);
}

std::string parts_csv(const Json& report) {
  Table table(columns_of(validate::part_fields()));
  for (const Json& part : report["parts"])
    table.add({{"part", part["name"]},
               {"command", part["command"]},
               {"seconds", part["seconds"]},
               {"forecast_seconds", part["forecast_seconds"]}});
  return table.csv();
}

/// A file for a picture, which ends with this.
class PictureFile {
 public:
  PictureFile() {
    const int file = mkstemps(path_.data(), 4);
    if (file < 0) throw sim::FileError(path_, "the picture cannot be kept there");
    close(file);
  }
  ~PictureFile() { std::filesystem::remove(path_, ignored_); }
  PictureFile(const PictureFile&) = delete;
  PictureFile& operator=(const PictureFile&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  std::error_code ignored_;
  std::string path_ = (std::filesystem::temp_directory_path(ignored_) / "detp-XXXXXX.png").string();
};

Result run_report(validate::ReportRequest request, const CommonOptions& common, const std::stop_token& stop) {
  if (!common.output) throw std::invalid_argument("report writes a page: give -o FILE.html");
  check_target(request);
  if (common.seed != CommonOptions{}.seed) request.common = {"--seed", std::to_string(common.seed)};
  if (common.threads != 0) request.common.insert(request.common.end(), {"--threads", std::to_string(common.threads)});
  const ProgressLine progress(common.quiet);
  const PictureFile picture;
  const auto ask_program = [&](std::vector<std::string> words) {
    std::ranges::replace(words, std::string(validate::picture_name), picture.path());
    return ask(words, stop);
  };
  Json report = validate::answer(request, ask_program, stop, progress.report());
  Result result;
  result.inputs = std::move(report["inputs"]);
  report.erase("inputs");
  if (report["stopped"] == true) result.stopped.emplace();
  result.text = report_text(report, *common.output, common.screen());
  result.csv = parts_csv(report);
  result.json = std::move(report);
  Result shown = result;
  const Json whole = envelope("report", common, sim::thread_count(common.threads), shown);
  sim::OutputFile file(*common.output, stop);
  file.write(validate::page_html(whole, picture.bytes()));
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
  const auto options = std::make_shared<validate::ReportRequest>();
  app->add_option("SCENE", options->scene, "a mesh or a built-in scene")->required();
  add_count(*app, "--rays", options->rays, "how many rays, as 100k; default: 100k");
  app->add_option(
      "--disc-radius", options->disc_radius,
      "d: a length, or a percentage of the scene's longest side; default: half the distance between samples");
  add_count(*app, "--samples", options->samples, "how many samples; default: the scene's vertices");
  app->add_option("--light", options->lights, "lights placed in the scene, as of run; default: the scene's own");
  app->add_option("--up", options->up, "which way is up, as of run; default: auto");
  app->add_flag("--front-facing", options->front_facing, "light that arrives from behind does not count");
  app->add_option("--target-error", options->target_error,
                  "noise and bias together, as 5%, whose cost is asked for; default: 5% noise");
  app->add_option("--target-noise", options->target_noise, "noise whose cost is asked for; default: 5%");
  app->add_flag("--quick", options->quick,
                "smaller map, pilots of some seconds, closed forms of one technique; default: all of it");
  return {app,
          [options](const CommonOptions& common, const std::stop_token& stop) {
            return run_report(*options, common, stop);
          },
          false, validate::describe_report()};
}

}  // namespace detp::cli
