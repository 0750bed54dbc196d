#include "choose_parts.hpp"

#include <fmt/format.h>

#include <cmath>

#include "detp/validate/choice/prediction_error.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/table.hpp"
#include "detp/validate/cli/text/words.hpp"

namespace detp::cli {

std::string why_not_measured(const validate::Analysis& analysis, const validate::Analysed& run) {
  if (run.given_up_after) return fmt::format("given up after {:.2g} s", *run.given_up_after);
  if (!run.refused.empty()) return "not run: " + run.refused;
  return analysis.stopped ? "stopped before" : "not timed";
}

namespace {

std::vector<const validate::Analysed*> to_explain(const validate::Analysis& analysis) {
  std::vector<const validate::Analysed*> runs{&analysis.candidates.front()};
  if (analysis.best && *analysis.best != 0) runs.push_back(&analysis.candidates[*analysis.best]);
  return runs;
}

/// "12 % too high: counts 2 % too low, unit costs 14 % too high": seconds and the two causes of their error.
std::string causes(const validate::PredictionError& error) {
  return fmt::format("{}: counts {}, unit costs {}", how_far_off(error.seconds), how_far_off(error.counts),
                     how_far_off(error.unit_costs));
}

/// The line "predicted": how well the seconds of the predicted choice were predicted. Its interval is of two standard
/// errors: times and over (1 + the relative error)².
std::string predicted_line(const ChooseAnswer& answer) {
  const validate::Analysed& run = answer.analysis->candidates.front();
  if (!run.predicted || !run.counted || !run.seconds) return "";
  const double seconds = run.predicted->time.again();
  const auto ratios = validate::prediction_error(*run.predicted, *run.counted, *run.seconds, answer.costs);
  std::string text =
      fmt::format("predicted {:.2g} s{}", seconds, answer.analysis->best == 0U ? "" : " for that choice");
  const double error = error_of(answer, rows_of(answer).front()).value_or(0) / run.predicted->time.total();
  if (!(error > 0)) return text + ", " + causes(ratios);
  const double factor = (1 + error) * (1 + error);
  const bool inside = *run.seconds > seconds / factor && *run.seconds < seconds * factor;
  return text + fmt::format(" ({:.2g} to {:.2g}): measured {}, {}", seconds / factor, seconds * factor,
                            inside ? "inside" : "outside", causes(ratios));
}

std::string missed_line(const validate::Analysed& run, const CostTable& costs) {
  const std::string tried = title(run.candidate);
  if (!run.predicted) return fmt::format("missed    {} has no closed form: it was not predicted", tried);
  if (!run.counted || !run.seconds) return "";
  const auto error = validate::prediction_error(*run.predicted, *run.counted, *run.seconds, costs);
  return fmt::format(
      "missed    {}: predicted seconds {}; the count that matters most: {}, {}", tried, causes(error), error.worst,
      std::isfinite(error.worst_ratio) ? how_far_off(error.worst_ratio) : "predicted, but never counted");
}

Json missed_json(const validate::Analysed& run, const CostTable& costs) {
  Json json{{"technique", name(run.candidate.technique)},
            {"parameters", to_json(run.candidate)},
            {"predicted", run.predicted.has_value()}};
  json.update(missed_ratios(run, costs));
  return json;
}

}  // namespace

Json missed_ratios(const validate::Analysed& run, const CostTable& costs) {
  if (!run.predicted || !run.counted || !run.seconds) return Json::object();
  const auto error = validate::prediction_error(*run.predicted, *run.counted, *run.seconds, costs);
  return {{"seconds_ratio", known(error.seconds)},
          {"counts_ratio", known(error.counts)},
          {"unit_costs_ratio", known(error.unit_costs)},
          {"worst_count", error.worst},
          {"worst_count_ratio", known(error.worst_ratio)}};
}

std::vector<TextColumn> measured_table_columns() {
  return {{.head = "tests", .spare = 3, .group = "counted"},
          {.head = "seconds", .align = Align::left, .group = "measured"},
          {.head = "tests", .spare = 2, .group = "predicted / measured"},
          {.head = "seconds", .align = Align::left, .group = "predicted / measured"}};
}

std::vector<TextCell> measured_cells(const validate::Analysed& run) {
  std::vector<TextCell> cells(4);
  if (!run.counted) return cells;
  const auto counted = static_cast<double>(tests(*run.counted));
  cells[0].text = fmt::format("{:.3g}", counted);
  if (run.predicted && counted > 0) cells[2].text = fmt::format("{:.2f}", tests(run.predicted->counts) / counted);
  if (!run.seconds) return cells;
  cells[1].text = fmt::format("{:.3g}", *run.seconds);
  if (run.spread > 0) cells[1].text += fmt::format(" ± {:.1g}", run.spread);
  if (!run.predicted) return cells;
  const double ratio = run.predicted->time.again() / *run.seconds;
  const bool far_off = ratio > 2 || ratio < 0.5;
  cells[3] = {fmt::format("{:.2f}{}", ratio, far_off ? " !" : ""), far_off ? Style::doubtful : Style::plain};
  return cells;
}

void add_measured(Json& json, const validate::Analysis& analysis, const validate::Analysed& run) {
  if (run.counted) json["counted"] = to_json(*run.counted);
  if (run.seconds) {
    json["measured_seconds"] = *run.seconds;
    json["measured_spread"] = run.spread;
  } else {
    json["not_run"] = why_not_measured(analysis, run);
  }
  if (run.given_up_after) json["given_up_after_seconds"] = *run.given_up_after;
}

namespace {

/// 0.123 as "12".
std::string percent_digits(double share) {
  return share < 0.095 ? fmt::format("{:.1g}", 100 * share) : fmt::format("{:.0f}", 100 * share);
}

/// The line "regret": whether the predicted choice was the right one.
std::string regret_line(const validate::Analysis& analysis) {
  const validate::Analysed& predicted = analysis.candidates.front();
  const validate::Analysed& best = analysis.candidates[*analysis.best];
  if (&predicted == &best) return "regret    0 %: the predicted choice was right";
  if (!analysis.regret) return "";
  const double regret = *analysis.regret;
  const double error = analysis.regret_error;
  return fmt::format("regret    {}{} %: {}, the predicted choice, takes {:.3g} s{}", percent_digits(regret),
                     error > 0 ? " ± " + percent_digits(error) : "", title(predicted.candidate), *predicted.seconds,
                     regret <= error || regret < 0.01 ? ": as fast, within the noise of the timed runs" : "");
}

}  // namespace

std::string measured_lines(const ChooseAnswer& answer, const Screen& screen) {
  const validate::Analysis& analysis = *answer.analysis;
  std::string text;
  const auto add = [&](const std::string& line) {
    if (!line.empty()) text += wrapped(line, screen.text_width(), 10);
  };
  if (analysis.best) {
    const validate::Analysed& best = analysis.candidates[*analysis.best];
    text += choice_text(fmt::format("{}, {}: measured {:.3g}{} s, the fastest of {} tried", title(best.candidate),
                                    threads_text(best.threads), *best.seconds,
                                    best.spread > 0 ? fmt::format(" ± {:.1g}", best.spread) : "", analysis.tried),
                        screen);
    add(regret_line(analysis));
    add(predicted_line(answer));
  }
  if (analysis.stopped)
    add(fmt::format("tried     {} of {} candidates before the stop: the others may be faster", analysis.tried,
                    analysis.candidates.size()));
  return text;
}

std::string gain_line(const ChooseAnswer& answer) {
  const validate::Analysis& analysis = *answer.analysis;
  if (!analysis.best) return "";
  const double seconds = *analysis.candidates[*analysis.best].seconds;
  // The counts of brute force are exact. Those of the paper's rule are extrapolated in a scene, up to ten times too high.
  return fmt::format("gain      testing every ray with every disc would take {:.2g} s (predicted), {}",
                     answer.brute_force, as_long(answer.brute_force / seconds));
}

std::string missed_lines(const ChooseAnswer& answer, const Screen& screen) {
  std::string text;
  if (!answer.analysis->best) return text;
  for (const validate::Analysed* run : to_explain(*answer.analysis))
    if (const std::string line = missed_line(*run, answer.costs); !line.empty())
      text += wrapped(line, screen.text_width(), 10);
  return text;
}

std::string choice_text(const std::string& what, const Screen& screen) {
  std::string lines = wrapped("choice    " + what, screen.text_width(), 10);
  lines.pop_back();
  return styled(screen, Style::strong, lines) + "\n";
}

void add_analysis(Json& json, const ChooseAnswer& answer) {
  const validate::Analysis& analysis = *answer.analysis;
  const Prediction& predicted = answer.choice.best();
  json["predicted_choice"] = {{"technique", name(predicted.candidate.technique)},
                              {"parameters", to_json(predicted.candidate)},
                              {"threads", predicted.threads},
                              {"predicted_seconds", predicted.time.total()},
                              {"predicted_seconds_again", predicted.time.again()}};
  if (analysis.best) {
    const validate::Analysed& best = analysis.candidates[*analysis.best];
    json["best_measured"] = {{"technique", name(best.candidate.technique)},
                             {"parameters", to_json(best.candidate)},
                             {"threads", best.threads},
                             {"measured_seconds", *best.seconds},
                             {"measured_spread", best.spread}};
    json["missed"] = Json::array();
    for (const validate::Analysed* run : to_explain(analysis))
      json["missed"].push_back(missed_json(*run, answer.costs));
  }
  json["tried"] = analysis.tried;
  if (analysis.regret) {
    json["regret"] = *analysis.regret;
    json["regret_error"] = analysis.regret_error;
  }
  json["stopped"] = analysis.stopped;
}

}  // namespace detp::cli
