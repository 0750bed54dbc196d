#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "choose.hpp"
#include "detp/validate/answer/parts.hpp"

namespace detp::validate {
namespace {

std::string why_not(const ChooseAnswer& answer, const ChooseRow& row) {
  if (const Analysed* const fastest = answer.fastest(); row.run != nullptr && fastest != nullptr) {
    if (row.run->seconds) return fmt::format("measured {:.3g}x slower", *row.run->seconds / *fastest->seconds);
    if (row.run->given_up_after)
      return fmt::format("took over {:.3g}x as long and was given up", *row.run->given_up_after / *fastest->seconds);
  }
  if (row.predicted == nullptr) return "not measured, and it has no closed form";
  const double ratio = row.predicted->seconds() / answer.choice.best().seconds();
  if (row.predicted->seconds() < answer.choice.best().seconds())
    return "predicted faster, but within the error of closed forms or unit costs";
  return fmt::format("predicted {:.3g}x slower, mostly {}", ratio, largest_part(row.predicted->time));
}

std::string why_not_timed(const Analysis& analysis, const Analysed& run) {
  if (run.seconds) return "";
  if (run.given_up_after) return fmt::format("given up after {:.2g} s", *run.given_up_after);
  if (!run.refused.empty()) return "not run: " + run.refused;
  return analysis.stopped ? "stopped before" : "not timed";
}

ChooseRow row_of(const ChooseAnswer& answer, const Candidate& candidate, int threads, const Prediction* predicted,
                 const Analysed* run) {
  ChooseRow row{.role = "candidate",
                .candidate = candidate,
                .engine = answer.costs.engine,
                .threads = threads,
                .predicted = predicted,
                .run = run};
  if (answer.by_sample()) {
    const auto& all = answer.choice.candidates;
    const auto same = std::ranges::find(all, candidate, &Prediction::candidate);
    if (same != all.end()) row.sampled = &*same;
  }
  row.could_win = predicted != nullptr && predicted->seconds() < (1 + distinguishable) * answer.choice.best().seconds();
  if (run != nullptr) row.not_run = why_not_timed(*answer.analysis, *run);
  if (predicted != nullptr && run != nullptr && run->counted && run->seconds)
    row.missed = prediction_error(*predicted, *run->counted, *run->seconds, answer.costs);
  return row;
}

const Fields<PredictionError>& error_fields() {
  static const Fields<PredictionError> fields{
      {"seconds_ratio", "", "predicted over measured seconds", &PredictionError::seconds},
      {"counts_ratio", "", "the part of it that is due to the counts", &PredictionError::counts},
      {"unit_costs_ratio", "", "the part that is due to the unit costs", &PredictionError::unit_costs},
      {"worst_count", "", "the count whose error changes the time most", &PredictionError::worst},
      {"worst_count_ratio", "", "of this count: predicted over counted", &PredictionError::worst_ratio}};
  return fields;
}

}  // namespace

std::string_view largest_part(const CostBreakdown& time) {
  const std::array<std::pair<double, std::string_view>, 7> parts{{{time.order, "sorting samples"},
                                                                  {time.build, "building the index"},
                                                                  {time.rebuild, "ray-sphere tests"},
                                                                  {time.copy, "copying lists"},
                                                                  {time.traverse, "stepping through the index"},
                                                                  {time.intersect, "ray-disc tests"},
                                                                  {time.touch, "touching new memory"}}};
  return std::ranges::max_element(parts)->second;
}

std::vector<ChooseRow> rows_of(const ChooseAnswer& answer) {
  std::vector<ChooseRow> rows;
  if (answer.analysis) {
    for (const Analysed& run : answer.analysis->candidates)
      rows.push_back(row_of(answer, run.candidate, run.threads, run.predicted ? &*run.predicted : nullptr, &run));
    rows.front().role = "predicted choice";
  } else {
    for (const Prediction& one : answer.choice.candidates)
      rows.push_back(row_of(answer, one.candidate, one.threads, &one, nullptr));
  }
  rows[answer.analysis ? answer.analysis->best.value_or(0) : 0].role = "choice";
  for (ChooseRow& row : rows)
    if (!row.chosen()) row.why_not = why_not(answer, row);
  return rows;
}

ChooseRow paper_row(const ChooseAnswer& answer) {
  return {.role = "paper rule",
          .candidate = answer.paper.candidate,
          .engine = answer.costs.engine,
          .threads = answer.paper.threads,
          .predicted = &answer.paper};
}

std::vector<ChooseRow> explained_rows(const ChooseAnswer& answer) {
  std::vector<ChooseRow> rows = rows_of(answer);
  const std::size_t best = answer.analysis->best.value();
  if (best != 0) rows[1] = rows[best];
  rows.erase(rows.begin() + (best == 0 ? 1 : 2), rows.end());
  return rows;
}

const Fields<ChooseRow>& choose_row_fields() {
  static const Fields<ChooseRow> fields = [] {
    using Of = Field<ChooseRow>;
    const auto predicted = [](auto value) { return of_part(&ChooseRow::predicted, value); };
    const auto sampled = [](auto value) { return of_part(&ChooseRow::sampled, value); };
    const auto run = [](auto value) { return of_part(&ChooseRow::run, value); };
    const auto said = [](std::string ChooseRow::*text) {
      return [text](const ChooseRow& row) { return (row.*text).empty() ? left_out() : Json(row.*text); };
    };
    const Fields<ChooseRow> role{
        Of("role", "", "choice, predicted choice, candidate, or paper rule", &ChooseRow::role).in_tables_alone()};
    const Fields<ChooseRow> others{
        Of("engine", "", "simd or plain", [](const ChooseRow& row) { return name(row.engine); }).in_tables_alone(),
        {"threads", "", "number of threads of prediction and runs", &ChooseRow::threads},
        Of("predicted", "", "predicted counts", predicted([](const Prediction& one) { return to_json(one.counts); }))
            .as_counts("predicted_"),
        {"predicted_seconds", "s", "predicted time, sorting and building included", predicted(&Prediction::seconds)},
        {"predicted_seconds_again", "s", "the same of a repeated search, in memory that is there already",
         predicted([](const Prediction& one) { return one.time.again(); })},
        {"predicted_seconds_error", "s", "its standard error; only of a pilot", sampled(&Prediction::error)},
        {"could_still_win", "", "its time cannot be told apart from that of the predicted choice",
         [](const ChooseRow& row) { return row.sampled != nullptr ? Json(row.could_win) : left_out(); }},
        {"extrapolated", "", "its closed form is used where it was not compared with counts",
         predicted([](const Prediction& one) { return !one.extrapolated.empty(); })},
        {"extrapolated_because", "", "the reasons", predicted(&Prediction::extrapolated)},
        Of("tuned", "", "the parameters are the best ones; else only good ones", predicted(&Prediction::tuned))
            .in_json_alone(),
        Of("predicted_error", "", "standard errors of the predicted counts; only of a pilot",
           sampled([](const Prediction& one) {
             return one.source == Source::closed_form ? left_out() : to_json(one.counts_error);
           }))
            .as_counts("predicted_error_"),
        Of("counted", "", "counts of a run",
           run([](const Analysed& one) { return one.counted ? to_json(*one.counted) : left_out(); }))
            .as_counts("counted_"),
        {"measured_seconds", "s", "median of the timed runs", run(&Analysed::seconds)},
        {"measured_spread", "s", "half the range of the timed runs",
         run([](const Analysed& one) { return one.seconds ? std::optional(one.spread) : std::nullopt; })},
        {"given_up_after_seconds", "s", "after which its run was abandoned", run(&Analysed::given_up_after)},
        {"not_run", "", "why it was not timed", said(&ChooseRow::not_run)},
        {"why_not", "", "why it is not the choice", said(&ChooseRow::why_not)}};
    Fields<ChooseRow> all = role + fields_of_part<ChooseRow>(candidate_fields(), &ChooseRow::candidate) + others;
    for (const Of& field : fields_of_part<ChooseRow>(error_fields(), &ChooseRow::missed))
      all.push_back(field.in_tables_alone());
    return all;
  }();
  return fields;
}

const Fields<ChooseRow>& missed_fields() {
  static const Fields<ChooseRow> fields =
      fields_of_part<ChooseRow>(candidate_fields(), &ChooseRow::candidate) +
      Fields<ChooseRow>{{"predicted", "", "whether it was predicted",
                         [](const ChooseRow& row) { return row.predicted != nullptr; }}} +
      fields_of_part<ChooseRow>(error_fields(), &ChooseRow::missed);
  return fields;
}

}  // namespace detp::validate
