#include <fmt/format.h>

#include "command.hpp"
#include "detp/validate/calibration/calibrate_answer.hpp"
#include "detp/validate/cli/options/candidate_options.hpp"
#include "detp/validate/cli/options/number_option.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/cli/text/table.hpp"

namespace detp::cli {
namespace {

struct CalibrateOptions {
  double seconds = validate::CalibrateRequest{}.seconds;
  InstructionSetOption instruction_set;
};

/// "t 0.53, u 0.16" in nanoseconds.
std::string costs_text(const UnitCosts& costs) {
  std::string list;
  for (const UnitCostTerm& term : unit_cost_terms)
    if (costs.*term.cost > 0)
      list += fmt::format("{}{} {:.3g}", list.empty() ? "" : ", ", term.symbol, 1e9 * costs.*term.cost);
  return list;
}

TextCell left_out_cell(double error) {
  return {fmt::format("{:.1f}", 100 * error), error > validate::doubtful_error ? Style::doubtful : Style::plain};
}

std::vector<TextCell> fit_cells(const validate::FitQuality& fit, std::initializer_list<std::string> more) {
  std::vector<TextCell> cells{{std::string(name(fit.technique))},
                              {std::string(name(fit.engine))},
                              {fmt::format("{}", fit.runs)},
                              {fmt::format("{:.1f}", 100 * fit.median_error)},
                              left_out_cell(fit.left_out_median_error())};
  for (const std::string& text : more) cells.push_back({text});
  return cells;
}

std::string thread_table(const std::vector<validate::ThreadFit>& fits, const Screen& screen) {
  TextTable table({{.head = "technique", .align = Align::left},
                   {.head = "engine", .align = Align::left},
                   {.head = "runs"},
                   {.head = "median error", .group = "% of the seconds"},
                   {.head = "left out", .group = "% of the seconds"},
                   {.head = "preparing", .group = "serial share, %"},
                   {.head = "search", .group = "serial share, %"},
                   {.head = "start, microseconds"}});
  for (const validate::ThreadFit& fit : fits)
    table.add(fit_cells(
        fit, {fmt::format("{:.0f}", 100 * fit.costs.serial_preparing),
              fmt::format("{:.0f}", 100 * fit.costs.serial_search), fmt::format("{:.3g}", 1e6 * fit.costs.start)}));
  return table.text(screen);
}

std::string calibrate_text(const validate::CalibrateAnswer& answer, const Screen& screen) {
  const validate::MeasuredCalibration& calibration = answer.calibration;
  TextTable table({{.head = "technique", .align = Align::left},
                   {.head = "engine", .align = Align::left},
                   {.head = "runs"},
                   {.head = "median error", .group = "% of the seconds"},
                   {.head = "left out", .group = "% of the seconds"},
                   {.head = "condition", .spare = 1},
                   {.head = "nanoseconds", .align = Align::left}});
  for (const validate::CostFit& fit : calibration.fits)
    table.add(fit_cells(fit, {fmt::format("{:.0f}", fit.condition), costs_text(fit.costs)}));
  std::string text = table.text(screen);
  std::string symbols =
      "left out: the error on workloads that were left out of the fit. condition: of the fit's matrix.";
  for (const UnitCostTerm& term : unit_cost_terms) symbols += fmt::format(" {}: {}.", term.symbol, term.meaning);
  text += legend(screen, symbols) + "\n";
  if (calibration.threads_left_out_median_error > 0)
    text += thread_table(calibration.thread_fits, screen) +
            legend(screen,
                   "runs on several threads, from the same runs on one. serial share: of the work that one thread does "
                   "while the others wait; preparing: sorting and building. start: of each further thread.") +
            "\n";
  const auto add = [&](const std::string& line) { text += wrapped(line, screen.text_width(), 10); };
  add(fmt::format("error     {:.2g} % in the median, on {} workloads left out of the fit in turn{}",
                  100 * calibration.left_out_median_error, calibration.workloads,
                  calibration.doubt().empty() ? "" : "; predicted seconds are doubtful"));
  if (calibration.threads_left_out_median_error > 0)
    add(fmt::format("threads   {:.2g} % in the median, of the time on several threads from that on one",
                    100 * calibration.threads_left_out_median_error));
  if (calibration.processor_share < validate::doubtful_share)
    add(
        fmt::format("busy      other programs used this machine: {:.0f} % of the time went to detp; the costs are in "
                    "processor time",
                    100 * calibration.processor_share));
  add("saved     " + (answer.saved.empty() ? "no: " + answer.not_saved_because : answer.saved));
  return text;
}

Result run_calibrate(const CalibrateOptions& options, const CommonOptions& common, const std::stop_token& stop) {
  require_positive("--seconds", options.seconds);
  const validate::CalibrateRequest request{.seconds = options.seconds,
                                           .threads = common.threads,
                                           .instruction_set = options.instruction_set.only(),
                                           .output = common.output};
  const ProgressLine progress(common.quiet);
  const validate::CalibrateAnswer answer = validate::answer(request, stop, progress.report());
  if (answer.could_be_saved)
    note(common, fmt::format("not saved: {}; --output FILE saves it in any case", answer.not_saved_because));
  Result result;
  result.inputs = {{"seconds", options.seconds}};
  result.json = json_of(validate::calibrate_fields(), answer);
  result.text = calibrate_text(answer, common.screen());
  Table table(validate::calibrate_columns());
  for (const Json& row : validate::calibrate_rows(answer.calibration)) table.add(row);
  result.csv = table.csv();
  result.output_is_written = true;
  if (answer.calibration.stopped) result.stopped = sim::Progress{answer.calibration.workloads, 0, "workloads measured"};
  return result;
}

}  // namespace

Command calibrate_command(CLI::App& program) {
  CLI::App* app = program.add_subcommand("calibrate", "The unit costs of this machine, saved for later commands");
  app->footer(
      "Example: detp calibrate --seconds 10\n--output FILE saves the calibration there instead, even if it is "
      "doubtful.");
  const auto options = std::make_shared<CalibrateOptions>();
  add_number(*app, "--seconds", options->seconds, "time for the measurements; default: 8");
  options->instruction_set.add_to(*app, "the kernels, one");
  return {app,
          [options](const CommonOptions& common, const std::stop_token& stop) {
            return run_calibrate(*options, common, stop);
          },
          false, validate::describe_calibrate()};
}

}  // namespace detp::cli
