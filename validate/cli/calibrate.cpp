#include <fmt/format.h>

#include "command.hpp"
#include "detp/sim/lists/simd/instruction_sets.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "detp/validate/cli/options/candidate_options.hpp"
#include "detp/validate/cli/options/number_option.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/cli/text/table.hpp"
#include "detp/validate/statistics/statistics.hpp"

namespace detp::cli {
namespace {

struct CalibrateOptions {
  double seconds = validate::CalibrationOptions{}.seconds;
  InstructionSetOption instruction_set;
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

/// Calls visit(engine, technique, fit) for each fit among `fits`, a member of EngineCalibration.
template <class Fits, class Visit>
void for_each_fit(const validate::Calibration& calibration, Fits validate::EngineCalibration::*fits,
                  const Visit& visit) {
  for (const Engine engine : {Engine::simd, Engine::plain})
    for (const Technique technique : all_techniques)
      if (const auto& fit = (calibration.of(engine).*fits)[static_cast<std::size_t>(technique)])
        visit(engine, technique, *fit);
}

Json fits_json(const validate::Calibration& calibration) {
  Json fits = Json::array();
  for_each_fit(calibration, &validate::EngineCalibration::fits,
               [&](Engine engine, Technique technique, const validate::CostFit& fit) {
                 fits.push_back({{"technique", name(technique)},
                                 {"engine", name(engine)},
                                 {"runs", fit.runs},
                                 {"median_error", fit.median_error},
                                 {"left_out_median_error", validate::median(fit.left_out_errors)},
                                 {"condition", fit.condition},
                                 {"fitted", joined_symbols(fit.fitted)},
                                 {"dropped", joined_symbols(fit.dropped)}});
               });
  return fits;
}

Json thread_fits_json(const validate::Calibration& calibration) {
  Json fits = Json::array();
  for_each_fit(calibration, &validate::EngineCalibration::thread_fits,
               [&](Engine engine, Technique technique, const validate::ThreadFit& fit) {
                 fits.push_back({{"technique", name(technique)},
                                 {"engine", name(engine)},
                                 {"runs", fit.runs},
                                 {"median_error", fit.median_error},
                                 {"left_out_median_error", validate::median(fit.left_out_errors)}});
               });
  return fits;
}

TextCell left_out_cell(double error) {
  return {fmt::format("{:.1f}", 100 * error), error > validate::doubtful_error ? Style::doubtful : Style::plain};
}

std::string thread_table(const validate::Calibration& calibration, const Screen& screen) {
  TextTable table({{.head = "technique", .align = Align::left},
                   {.head = "engine", .align = Align::left},
                   {.head = "runs"},
                   {.head = "median error", .group = "% of the seconds"},
                   {.head = "left out", .group = "% of the seconds"},
                   {.head = "preparing", .group = "serial share, %"},
                   {.head = "search", .group = "serial share, %"},
                   {.head = "start, microseconds"}});
  for_each_fit(calibration, &validate::EngineCalibration::thread_fits,
               [&](Engine engine, Technique technique, const validate::ThreadFit& fit) {
                 table.add({{std::string(name(technique))},
                            {std::string(name(engine))},
                            {fmt::format("{}", fit.runs)},
                            {fmt::format("{:.1f}", 100 * fit.median_error)},
                            left_out_cell(validate::median(fit.left_out_errors)),
                            {fmt::format("{:.0f}", 100 * fit.costs.serial_preparing)},
                            {fmt::format("{:.0f}", 100 * fit.costs.serial_search)},
                            {fmt::format("{:.3g}", 1e6 * fit.costs.start)}});
               });
  return table.text(screen);
}

/// Where a calibration was saved, or why it was not.
struct Saved {
  std::string path = {};
  std::string why_not = {};
};

/// Saves it where later commands look for it, unless there is a better one; with --output there, in any case.
Saved save(const validate::Calibration& calibration, const CommonOptions& common) {
  if (calibration.stopped) return {.why_not = "stopped"};
  if (common.output) {
    validate::write_calibration(*common.output, calibration);
    return {.path = *common.output};
  }
  const std::string path = validate::default_calibration_path();
  if (path.empty()) return {.why_not = "there is no folder for it"};
  const std::string kept = validate::save_calibration(path, calibration);
  if (kept.empty()) return {.path = path};
  note(common, fmt::format("not saved: {}; --output FILE saves it in any case", kept));
  return {.why_not = kept};
}

std::string to_text(const validate::Calibration& calibration, const Saved& saved, const Screen& screen) {
  TextTable table({{.head = "technique", .align = Align::left},
                   {.head = "engine", .align = Align::left},
                   {.head = "runs"},
                   {.head = "median error", .group = "% of the seconds"},
                   {.head = "left out", .group = "% of the seconds"},
                   {.head = "condition", .spare = 1},
                   {.head = "nanoseconds", .align = Align::left}});
  for_each_fit(calibration, &validate::EngineCalibration::fits,
               [&](Engine engine, Technique technique, const validate::CostFit& fit) {
                 table.add({{std::string(name(technique))},
                            {std::string(name(engine))},
                            {fmt::format("{}", fit.runs)},
                            {fmt::format("{:.1f}", 100 * fit.median_error)},
                            left_out_cell(validate::median(fit.left_out_errors)),
                            {fmt::format("{:.0f}", fit.condition)},
                            {costs_text(fit.costs)}});
               });
  std::string text = table.text(screen);
  std::string symbols =
      "left out: the error on workloads that were left out of the fit. condition: of the fit's matrix.";
  for (const UnitCostTerm& term : unit_cost_terms) symbols += fmt::format(" {}: {}.", term.symbol, term.meaning);
  text += legend(screen, symbols) + "\n";
  if (calibration.threads_left_out_median_error > 0)
    text += thread_table(calibration, screen) +
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
  add("saved     " + (saved.path.empty() ? "no: " + saved.why_not : saved.path));
  return text;
}

std::string to_csv(const validate::Calibration& calibration) {
  Table table({"technique", "engine", "symbol", "seconds", "serial_preparing", "serial_search", "runs", "median_error",
               "left_out_median_error", "condition"});
  for_each_fit(calibration, &validate::EngineCalibration::fits,
               [&](Engine engine, Technique technique, const validate::CostFit& fit) {
                 for (const UnitCostTerm& term : unit_cost_terms)
                   if (fit.costs.*term.cost > 0)
                     table.add({{"technique", name(technique)},
                                {"engine", name(engine)},
                                {"symbol", term.symbol},
                                {"seconds", fit.costs.*term.cost},
                                {"runs", fit.runs},
                                {"median_error", fit.median_error},
                                {"left_out_median_error", validate::median(fit.left_out_errors)},
                                {"condition", fit.condition}});
               });
  for_each_fit(calibration, &validate::EngineCalibration::thread_fits,
               [&](Engine engine, Technique technique, const validate::ThreadFit& fit) {
                 table.add({{"technique", name(technique)},
                            {"engine", name(engine)},
                            {"symbol", "thread"},
                            {"seconds", fit.costs.start},
                            {"serial_preparing", fit.costs.serial_preparing},
                            {"serial_search", fit.costs.serial_search},
                            {"runs", fit.runs},
                            {"median_error", fit.median_error},
                            {"left_out_median_error", validate::median(fit.left_out_errors)}});
               });
  return table.csv();
}

Result run_calibrate(const CalibrateOptions& options, const CommonOptions& common, const std::stop_token& stop) {
  require_positive("--seconds", options.seconds);
  const std::string only = options.instruction_set.only();
  std::optional<sim::stream::OnlyInstructionSet> used;
  if (!only.empty()) used.emplace(only);
  const ProgressLine progress(common.quiet);
  const validate::Calibration calibration = validate::calibrate(
      {.seconds = options.seconds, .threads = common.threads, .stop = stop, .progress = progress.report()});
  const Saved saved = save(calibration, common);
  const Json stored = Json::parse(validate::calibration_text(calibration));
  Result result;
  result.inputs = {{"seconds", options.seconds}};
  result.json = {{"costs", stored["costs"]},
                 {"threads", stored["threads"]},
                 {"fits", fits_json(calibration)},
                 {"thread_fits", thread_fits_json(calibration)},
                 {"left_out_median_error", calibration.left_out_median_error},
                 {"threads_left_out_median_error", calibration.threads_left_out_median_error},
                 {"relative_error", calibration.relative_error()},
                 {"relative_errors", stored["relative_errors"]},
                 {"doubtful", !calibration.doubt().empty()},
                 {"workloads", calibration.workloads},
                 {"seconds", calibration.seconds},
                 {"processor_share", calibration.processor_share},
                 {"key", stored["key"]},
                 {"date", stored["date"]},
                 {"checksum", stored["checksum"]},
                 {"saved", saved.path}};
  result.text = to_text(calibration, saved, common.screen());
  result.csv = to_csv(calibration);
  result.output_is_written = true;
  if (calibration.stopped) result.stopped = sim::Progress{calibration.workloads, 0, "workloads measured"};
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
  return {app, [options](const CommonOptions& common, const std::stop_token& stop) {
            return run_calibrate(*options, common, stop);
          }};
}

}  // namespace detp::cli
