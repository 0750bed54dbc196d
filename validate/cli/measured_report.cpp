#include "measured_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "detp/validate/choice/prediction_error.hpp"
#include "workload_options.hpp"

namespace detp::cli {
namespace {

std::string title_of(const Candidate& candidate) {
  const std::string parameters = describe(candidate);
  return fmt::format("{}{}{}", name(candidate.technique), parameters.empty() ? "" : " ", parameters);
}

std::string why_not_measured(const validate::Analysis& analysis, const validate::Analysed& run) {
  if (run.given_up_after) return fmt::format("given up after {:.2g} s", *run.given_up_after);
  if (!run.refused.empty()) return "not run: " + run.refused;
  return analysis.stopped ? "stopped before" : "not timed";
}

/// Null if the number is not finite.
Json known(double number) { return std::isfinite(number) ? Json(number) : Json(); }

/// The predicted choice, and the fastest candidate if that is another one and has a prediction.
std::vector<const validate::Analysed*> to_explain(const validate::Analysis& analysis) {
  std::vector<const validate::Analysed*> runs{&analysis.candidates.front()};
  if (analysis.best && *analysis.best != 0) runs.push_back(&analysis.candidates[*analysis.best]);
  return runs;
}

std::string missed_line(const validate::Analysed& run, const UnitCosts& costs) {
  const std::string title = title_of(run.candidate);
  if (!run.predicted) return fmt::format("missed    {} has no closed form: it was not predicted\n", title);
  if (!run.counted || !run.seconds) return "";
  const auto error = validate::prediction_error(*run.predicted, *run.counted, *run.seconds, costs);
  return fmt::format(
      "missed    {}: predicted {:.3g} x its time = counts {:.3g} x (worst: {} {:.3g} x) times unit costs {:.3g} x\n",
      title, error.seconds, error.counts, error.worst, error.worst_ratio, error.unit_costs);
}

Json missed_json(const validate::Analysed& run, const UnitCosts& costs) {
  Json json{{"technique", name(run.candidate.technique)},
            {"parameters", to_json(run.candidate)},
            {"predicted", run.predicted.has_value()}};
  json.update(missed_ratios(run, costs));
  return json;
}

}  // namespace

Json missed_ratios(const validate::Analysed& run, const UnitCosts& costs) {
  if (!run.predicted || !run.counted || !run.seconds) return Json::object();
  const auto error = validate::prediction_error(*run.predicted, *run.counted, *run.seconds, costs);
  return {{"seconds_ratio", known(error.seconds)},
          {"counts_ratio", known(error.counts)},
          {"unit_costs_ratio", known(error.unit_costs)},
          {"worst_count", error.worst},
          {"worst_count_ratio", known(error.worst_ratio)}};
}

std::string measured_head(bool second_line) {
  return second_line ? "      tests  seconds              measured" : "    counted  measured             predicted/";
}

std::string measured_columns(const validate::Analysed& run) {
  if (!run.counted) return "";
  std::string text = fmt::format("  {:>9.3g}", static_cast<double>(tests(*run.counted)));
  if (!run.seconds) return text;
  text += fmt::format("  {:>8.3g} ±{:<8.1g}", *run.seconds, run.spread);
  if (!run.predicted) return text + fmt::format("  {:>6}  ", "-");
  const double ratio = run.predicted->time.total() / *run.seconds;
  return text + fmt::format("  {:>6.2f}{}", ratio, ratio > 2 || ratio < 0.5 ? " !" : "  ");
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

std::string measured_lines(const ChooseAnswer& answer) {
  const validate::Analysis& analysis = *answer.analysis;
  std::string text;
  if (analysis.best) {
    const validate::Analysed& best = analysis.candidates[*analysis.best];
    text += fmt::format("choice    {}: measured {:.3g} s, the fastest of {} tried\n", title_of(best.candidate),
                        *best.seconds, analysis.tried);
    const validate::Analysed& predicted = analysis.candidates.front();
    if (&predicted == &best)
      text += "predicted the same: no regret\n";
    else if (analysis.regret)
      text += fmt::format("predicted {}: measured {:.3g} s, {:.1f} % longer (the regret)\n",
                          title_of(predicted.candidate), *predicted.seconds, 100 * *analysis.regret);
    for (const validate::Analysed* run : to_explain(analysis)) text += missed_line(*run, answer.costs);
  }
  if (analysis.stopped)
    text += fmt::format("stopped   after {} of {} candidates: what was not tried may be faster\n", analysis.tried,
                        analysis.candidates.size());
  return text;
}

void add_analysis(Json& json, const ChooseAnswer& answer) {
  const validate::Analysis& analysis = *answer.analysis;
  const model::Ranked& predicted = answer.ranking.front();
  json["predicted_choice"] = {{"technique", name(predicted.candidate.technique)},
                              {"parameters", to_json(predicted.candidate)},
                              {"predicted_seconds", predicted.time.total()}};
  if (analysis.best) {
    const validate::Analysed& best = analysis.candidates[*analysis.best];
    json["best_measured"] = {{"technique", name(best.candidate.technique)},
                             {"parameters", to_json(best.candidate)},
                             {"measured_seconds", *best.seconds},
                             {"measured_spread", best.spread}};
    json["missed"] = Json::array();
    for (const validate::Analysed* run : to_explain(analysis))
      json["missed"].push_back(missed_json(*run, answer.costs));
  }
  json["tried"] = analysis.tried;
  if (analysis.regret) json["regret"] = *analysis.regret;
  json["stopped"] = analysis.stopped;
}

}  // namespace detp::cli
