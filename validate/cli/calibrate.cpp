#include <fmt/format.h>

#include "command.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "detp/validate/statistics/statistics.hpp"
#include "number_option.hpp"
#include "progress_line.hpp"
#include "table.hpp"
#include "text_table.hpp"

namespace detp::cli {
namespace {

struct CalibrateOptions {
  double seconds = 15;
};

std::string joined_symbols(const std::vector<std::string_view>& symbols) {
  std::string list;
  for (const std::string_view symbol : symbols) list += fmt::format("{}{}", list.empty() ? "" : ", ", symbol);
  return list;
}

/// "t 0.53, u 0.16" in nanoseconds.
std::string costs_text(const UnitCosts& costs) {
  std::string list;
  for (const UnitCostTerm& term : unit_cost_terms)
    if (costs.*term.cost > 0)
      list += fmt::format("{}{} {:.3g}", list.empty() ? "" : ", ", term.symbol, 1e9 * costs.*term.cost);
  return list;
}

Json fits_json(const validate::Calibration& calibration) {
  Json fits = Json::array();
  for (const Technique technique : all_techniques)
    if (const auto& fit = calibration.fits[static_cast<std::size_t>(technique)])
      fits.push_back({{"technique", name(technique)},
                      {"runs", fit->runs},
                      {"median_error", fit->median_error},
                      {"left_out_median_error", validate::median(fit->left_out_errors)},
                      {"condition", fit->condition},
                      {"fitted", joined_symbols(fit->fitted)},
                      {"dropped", joined_symbols(fit->dropped)}});
  return fits;
}

std::string to_text(const validate::Calibration& calibration, const std::string& saved, const Screen& screen) {
  TextTable table({{.head = "technique", .align = Align::left},
                   {.head = "runs"},
                   {.head = "median error", .group = "% of the seconds"},
                   {.head = "left out", .group = "% of the seconds"},
                   {.head = "condition", .spare = 1},
                   {.head = "nanoseconds", .align = Align::left}});
  for (const Technique technique : all_techniques)
    if (const auto& fit = calibration.fits[static_cast<std::size_t>(technique)]) {
      const double left_out = validate::median(fit->left_out_errors);
      table.add({{std::string(name(technique))},
                 {fmt::format("{}", fit->runs)},
                 {fmt::format("{:.1f}", 100 * fit->median_error)},
                 {fmt::format("{:.1f}", 100 * left_out),
                  left_out > validate::doubtful_error ? Style::doubtful : Style::plain},
                 {fmt::format("{:.0f}", fit->condition)},
                 {costs_text(fit->costs)}});
    }
  std::string text = table.text(screen);
  std::string symbols =
      "left out: the error on workloads that were left out of the fit. condition: of the fit's matrix.";
  for (const UnitCostTerm& term : unit_cost_terms) symbols += fmt::format(" {}: {}.", term.symbol, term.meaning);
  text += legend(screen, symbols) + "\n";
  const auto add = [&](const std::string& line) { text += wrapped(line, screen.text_width(), 10); };
  add(fmt::format("error     {:.2g} % in the median, on {} workloads left out of the fit in turn{}",
                  100 * calibration.left_out_median_error, calibration.workloads,
                  calibration.left_out_median_error > validate::doubtful_error
                      ? ": more than 15 %; predicted seconds are doubtful"
                      : ""));
  if (calibration.processor_share < 0.9)
    add(
        fmt::format("busy      other programs used this machine: {:.0f} % of the time went to detp; the costs are in "
                    "processor time",
                    100 * calibration.processor_share));
  add(saved.empty() ? "saved     no: " + std::string(calibration.stopped ? "stopped" : "there is no folder for it")
                    : "saved     " + saved);
  return text;
}

std::string to_csv(const validate::Calibration& calibration) {
  Table table({"technique", "symbol", "seconds", "runs", "median_error", "left_out_median_error", "condition"});
  for (const Technique technique : all_techniques)
    if (const auto& fit = calibration.fits[static_cast<std::size_t>(technique)])
      for (const UnitCostTerm& term : unit_cost_terms)
        if (fit->costs.*term.cost > 0)
          table.add({{"technique", name(technique)},
                     {"symbol", term.symbol},
                     {"seconds", fit->costs.*term.cost},
                     {"runs", fit->runs},
                     {"median_error", fit->median_error},
                     {"left_out_median_error", validate::median(fit->left_out_errors)},
                     {"condition", fit->condition}});
  return table.csv();
}

Result run_calibrate(const CalibrateOptions& options, const CommonOptions& common, const std::stop_token& stop) {
  require_positive("--seconds", options.seconds);
  const ProgressLine progress(common);
  const validate::Calibration calibration =
      validate::calibrate({.seconds = options.seconds, .stop = stop, .progress = progress.report()});
  const std::string path = common.output.value_or(validate::default_calibration_path());
  const bool save = !calibration.stopped && !path.empty();
  if (save) validate::write_calibration(path, calibration);
  const Json stored = Json::parse(validate::calibration_text(calibration));
  Result result;
  result.inputs = {{"seconds", options.seconds}};
  result.json = {{"costs", stored["costs"]},
                 {"fits", fits_json(calibration)},
                 {"left_out_median_error", calibration.left_out_median_error},
                 {"doubtful", calibration.left_out_median_error > validate::doubtful_error},
                 {"workloads", calibration.workloads},
                 {"seconds", calibration.seconds},
                 {"processor_share", calibration.processor_share},
                 {"key", stored["key"]},
                 {"date", stored["date"]},
                 {"saved", save ? path : ""}};
  result.text = to_text(calibration, save ? path : "", common.screen());
  result.csv = to_csv(calibration);
  result.output_is_written = true;
  if (calibration.stopped) result.stopped = sim::Progress{calibration.workloads, 0, "workloads measured"};
  return result;
}

}  // namespace

Command calibrate_command(CLI::App& program) {
  CLI::App* app = program.add_subcommand("calibrate", "The unit costs of this machine, saved for later commands");
  app->footer("Example: detp calibrate --seconds 10\n--output FILE saves the calibration there instead.");
  const auto options = std::make_shared<CalibrateOptions>();
  add_number(*app, "--seconds", options->seconds, "time for the measurements; default: 15");
  return {app, [options](const CommonOptions& common, const std::stop_token& stop) {
            return run_calibrate(*options, common, stop);
          }};
}

}  // namespace detp::cli
