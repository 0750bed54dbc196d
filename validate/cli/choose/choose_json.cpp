#include <fmt/format.h>

#include <algorithm>

#include "choose_report.hpp"
#include "choose_rows.hpp"
#include "choose_tips.hpp"
#include "detp/validate/cli/report/effects_report.hpp"
#include "detp/validate/cli/report/extrapolated.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "measured_report.hpp"

namespace detp::cli {
namespace {

std::string why_not(const ChooseAnswer& answer, const ChooseRow& row) {
  if (row.run != nullptr && answer.analysis->best) {
    const double fastest = *answer.analysis->candidates[*answer.analysis->best].seconds;
    if (row.run->seconds) return fmt::format("measured {:.3g}x slower", *row.run->seconds / fastest);
    if (row.run->given_up_after)
      return fmt::format("took over {:.3g}x as long and was given up", *row.run->given_up_after / fastest);
  }
  if (row.predicted == nullptr) return "not measured, and it has no closed form";
  const CostBreakdown& time = row.predicted->time;
  if (time.total() < answer.choice.best().time.total())
    return "predicted faster, but within the error of closed forms or unit costs";
  return fmt::format("predicted {:.3g}x slower, mostly {}", time.total() / answer.choice.best().time.total(),
                     largest_part(time));
}

Json candidate_json(const ChooseAnswer& answer, const ChooseRow& row) {
  Json json{{"technique", name(row.candidate.technique)},
            {"parameters", to_json(row.candidate)},
            {"threads", threads_of(row)}};
  if (row.predicted != nullptr) {
    json["predicted"] = to_json(row.predicted->counts);
    json["predicted_seconds"] = row.predicted->time.total();
    json["predicted_seconds_again"] = row.predicted->time.again();
    json["tuned"] = row.predicted->tuned;
    json.update(extrapolated_json(row.predicted->extrapolated));
    if (const auto error = error_of(answer, row)) {
      json["predicted_seconds_error"] = *error;
      if (piloted(answer, row)->source != Source::closed_form)
        json["predicted_error"] = to_json(piloted(answer, row)->counts_error);
      json["could_still_win"] = could_win(answer, row);
    }
  }
  if (!row.chosen) json["why_not"] = why_not(answer, row);
  if (row.run != nullptr) add_measured(json, *answer.analysis, *row.run);
  return json;
}

Json choice_json(const ChooseAnswer& answer, const ChooseRow& row) {
  Json json{{"technique", name(row.candidate.technique)},
            {"parameters", to_json(row.candidate)},
            {"threads", threads_of(row)}};
  if (row.predicted != nullptr) {
    json["predicted_seconds"] = row.predicted->time.total();
    json["predicted_seconds_again"] = row.predicted->time.again();
    if (const auto error = error_of(answer, row)) json["predicted_seconds_error"] = *error;
    json.update(extrapolated_json(row.predicted->extrapolated));
  }
  if (row.run != nullptr && row.run->seconds) {
    json["measured_seconds"] = *row.run->seconds;
    json["measured_spread"] = row.run->spread;
  }
  return json;
}

/// Why techniques that are not among the candidates were not considered.
void add_left_out(Json& json, const validate::Choice& choice) {
  json["ruled_out"] = Json::array();
  for (const validate::RuledOut& one : choice.ruled_out)
    json["ruled_out"].push_back(
        {{"technique", name(one.technique)}, {one.by_bound ? "at_least_seconds" : "predicted_seconds", one.seconds}});
  json["not_examined"] = names_json(choice.unexamined);
}

}  // namespace

Json to_json(const ChooseAnswer& answer) {
  const std::vector<ChooseRow> rows = rows_of(answer);
  const ChooseRow& chosen = *std::find_if(rows.begin(), rows.end(), [](const ChooseRow& row) { return row.chosen; });
  Json json{{"choice", choice_json(answer, chosen)},
            {"candidates", Json::array()},
            {"paper_rule",
             {{"technique", name(answer.paper.candidate.technique)},
              {"parameters", to_json(answer.paper.candidate)},
              {"threads", answer.paper.threads},
              {"predicted_seconds", answer.paper.time.total()}}},
            {"effects", to_json(answer.effects)},
            {"rigor", name(answer.rigor)},
            {"engine", name(answer.costs.engine)},
            {"unit_costs", answer.costs_origin},
            {"choosing_seconds",
             {{"total", answer.choosing_seconds},
              {"evidence", answer.evidence_seconds},
              {"evidence_shown", answer.shown_evidence_seconds},
              {"pilot", answer.by_sample() ? answer.choice.choosing_seconds : 0}}},
            {"choosing_share", answer.choosing_seconds / answer.choice.best().time.total()},
            {"whole", whole_json(whole_of(answer).seconds)},
            {"peak_bytes", *whole_of(answer).peak_bytes},
            {"warnings", answer.warnings}};
  json.update(answer.ledgers);
  if (answer.ranks) json["ranks"] = to_json(*answer.ranks);
  if (answer.by_sample()) add_left_out(json, answer.choice);
  json["paper_rule"].update(extrapolated_json(answer.paper.extrapolated));
  for (const ChooseRow& row : rows) json["candidates"].push_back(candidate_json(answer, row));
  add_tips(json, answer);
  if (answer.analysis) add_analysis(json, answer);
  return json;
}

}  // namespace detp::cli
