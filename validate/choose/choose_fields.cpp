#include "choose_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

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

Json jsons_of(const std::vector<ChooseRow>& rows, const Fields<ChooseRow>& fields) {
  Json all = Json::array();
  for (const ChooseRow& row : rows) all.push_back(json_of(fields, row));
  return all;
}

/// The rows' fields with these names.
Fields<ChooseRow> row_fields(const std::vector<std::string_view>& names) { return only(choose_row_fields(), names); }

const Fields<PredictionError>& error_fields() {
  static const Fields<PredictionError> fields{
      {"seconds_ratio", "", "predicted over measured seconds", &PredictionError::seconds},
      {"counts_ratio", "", "the part of it that is due to the counts", &PredictionError::counts},
      {"unit_costs_ratio", "", "the part that is due to the unit costs", &PredictionError::unit_costs},
      {"worst_count", "", "the count whose error changes the time most", &PredictionError::worst},
      {"worst_count_ratio", "", "of this count: predicted over counted", &PredictionError::worst_ratio}};
  return fields;
}

/// Of a prediction that is compared with a measurement.
const Fields<ChooseRow>& missed_fields() {
  static const Fields<ChooseRow> fields = [] {
    Fields<ChooseRow> all = fields_of_part<ChooseRow>(candidate_fields(), &ChooseRow::candidate);
    all.emplace_back("predicted", "", "whether it was predicted",
                     [](const ChooseRow& row) { return row.predicted != nullptr; });
    for (auto& field : fields_of_part<ChooseRow>(error_fields(), &ChooseRow::missed)) all.push_back(std::move(field));
    return all;
  }();
  return fields;
}

Json tips_range(const ChooseAnswer& answer) {
  Json json;
  for (const TipInput input : tip_inputs) {
    const TipRange& range = answer.tips.range(input);
    json[std::string(detp::name(input))] = input == TipInput::disc_radius
                                               ? Json::array({range.least, range.most})
                                               : Json::array({whole(range.least), whole(range.most)});
  }
  return json;
}

const Fields<Tip>& tip_fields() {
  const auto is_known = [](const Tip& tip) { return tip.kind != TipKind::not_ruled_out; };
  static const Fields<Tip> fields{
      {"input", "", "the input that would be another", [](const Tip& tip) { return detp::name(tip.input); }},
      {"at", "", "its value there",
       [](const Tip& tip) { return tip.input == TipInput::disc_radius ? Json(tip.at) : whole(tip.at); }},
      {"ratio", "", "the same over the present value", &Tip::ratio},
      {"change", "", "what changes there", [](const Tip& tip) { return detp::name(tip.kind); }},
      {"technique", "", "the technique there", [](const Tip& tip) { return name(tip.candidate.technique); }},
      {"parameters", "", "its parameters, if it is chosen there",
       [=](const Tip& tip) { return is_known(tip) ? to_json(tip.candidate) : left_out(); }},
      {"threads", "", "its number of threads, if it is chosen there",
       [=](const Tip& tip) { return is_known(tip) ? Json(tip.threads) : left_out(); }},
      {"text", "", "the tip in words", [](const Tip& tip) { return text_of(tip); }}};
  return fields;
}

const Fields<RuledOut>& ruled_out_fields() {
  static const Fields<RuledOut> fields{
      {"technique", "", "name of the technique", [](const RuledOut& one) { return name(one.technique); }},
      {"at_least_seconds", "s", "the least that it could take",
       [](const RuledOut& one) { return one.by_bound ? Json(one.seconds) : left_out(); }},
      {"predicted_seconds", "s", "what it takes by its closed form",
       [](const RuledOut& one) { return one.by_bound ? left_out() : Json(one.seconds); }}};
  return fields;
}

template <class Part>
Json list_json(const std::vector<Part>& parts, const Fields<Part>& fields) {
  Json all = Json::array();
  for (const Part& part : parts) all.push_back(json_of(fields, part));
  return all;
}

const Fields<model::SharedTime>& shared_time_fields() {
  using model::SharedTime;
  static const Fields<SharedTime> fields{
      {"predicted_seconds", "s", "of the slowest process", &SharedTime::total},
      {"count_seconds", "s", "of it, counting photons", &SharedTime::count},
      {"make_seconds", "s", "making its rays", &SharedTime::make},
      {"build_seconds", "s", "building an index", &SharedTime::build},
      {"search_seconds", "s", "the search", &SharedTime::search},
      {"collect_seconds", "s", "until rank 0 has what the others found", &SharedTime::collect},
      {"memory", "bytes", "of rank 0", &SharedTime::memory},
      {"traffic", "bytes", "that rank 0 receives", &SharedTime::traffic}};
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
    const auto run = [](auto value) { return of_part(&ChooseRow::run, value); };
    const auto said = [](const std::string& text) { return text.empty() ? left_out() : Json(text); };
    Fields<ChooseRow> all{
        Of("role", "", "choice, predicted choice, candidate, or that of the paper's rule", &ChooseRow::role)
            .in_tables_alone()};
    for (auto& field : fields_of_part<ChooseRow>(candidate_fields(), &ChooseRow::candidate))
      all.push_back(std::move(field));
    const Fields<ChooseRow> others{
        Of("engine", "", "simd or plain", [](const ChooseRow& row) { return name(row.engine); }).in_tables_alone(),
        {"threads", "", "number of threads of prediction and runs", &ChooseRow::threads},
        Of("predicted", "", "predicted counts", predicted([](const Prediction& one) { return to_json(one.counts); }))
            .as_counts("predicted_"),
        {"predicted_seconds", "s", "predicted time, sorting and building included", predicted(&Prediction::seconds)},
        {"predicted_seconds_again", "s", "the same of a repeated search, in memory that is there already",
         predicted([](const Prediction& one) { return one.time.again(); })},
        {"predicted_seconds_error", "s", "its standard error; only of a pilot",
         of_part(&ChooseRow::sampled, &Prediction::error)},
        {"could_still_win", "", "its time cannot be told apart from that of the predicted choice",
         [](const ChooseRow& row) { return row.sampled != nullptr ? Json(row.could_win) : left_out(); }},
        {"extrapolated", "", "its closed form is used where it was not compared with counts",
         predicted([](const Prediction& one) { return !one.extrapolated.empty(); })},
        {"extrapolated_because", "", "the reasons", predicted(&Prediction::extrapolated)},
        Of("tuned", "", "the parameters are the best ones; else only good ones", predicted(&Prediction::tuned))
            .in_json_alone(),
        Of("predicted_error", "", "standard errors of the predicted counts; only of a pilot",
           of_part(&ChooseRow::sampled,
                   [](const Prediction& one) {
                     return one.source == Source::closed_form ? left_out() : to_json(one.counts_error);
                   }))
            .as_counts("predicted_error_"),
        Of("counted", "", "counts of a run",
           run([](const Analysed& one) { return one.counted ? to_json(*one.counted) : left_out(); }))
            .as_counts("counted_"),
        {"measured_seconds", "s", "median of the timed runs",
         run([](const Analysed& one) { return if_any(one.seconds); })},
        {"measured_spread", "s", "half the range of the timed runs",
         run([](const Analysed& one) { return one.seconds ? Json(one.spread) : left_out(); })},
        {"given_up_after_seconds", "s", "after which its run was abandoned",
         run([](const Analysed& one) { return if_any(one.given_up_after); })},
        {"not_run", "", "why it was not timed", [=](const ChooseRow& row) { return said(row.not_run); }},
        {"why_not", "", "why it is not the choice", [=](const ChooseRow& row) { return said(row.why_not); }}};
    all.insert(all.end(), others.begin(), others.end());
    for (const auto& field : fields_of_part<ChooseRow>(error_fields(), &ChooseRow::missed))
      all.push_back(field.in_tables_alone());
    return all;
  }();
  return fields;
}

const Fields<RanksAnswer>& ranks_fields() {
  static const Fields<RanksAnswer> fields{
      {"count", "", "number of processes", &RanksAnswer::ranks},
      {"share", "", "what they share: rays or discs",
       [](const RanksAnswer& answer) { return answer.by_rays ? "rays" : "discs"; }},
      {"predicted_seconds", "s", "with making the rays",
       [](const RanksAnswer& answer) { return answer.best().total(); }},
      {"predicted_seconds_error", "s", "its standard error, as far as it is known", &RanksAnswer::error},
      {"alone_seconds", "s", "of one process", &RanksAnswer::alone},
      {"memory", "bytes", "of rank 0", [](const RanksAnswer& answer) { return answer.best().memory; }},
      {"memory_limit", "bytes", "that a rank may use", &RanksAnswer::memory_limit},
      {"fits", "", "the memory does not exceed the limit", &RanksAnswer::fits},
      {"traffic", "bytes", "that rank 0 receives", [](const RanksAnswer& answer) { return answer.best().traffic; }},
      {"network_bytes_per_second", "bytes/s", "between two processes",
       [](const RanksAnswer& answer) { return answer.network.bytes_per_second; }},
      {"network_latency", "s", "of a message", [](const RanksAnswer& answer) { return answer.network.latency; }},
      {"shares", "", "both ways to share, by part of the time", [](const RanksAnswer& answer) {
         return Json{{"rays", json_of(shared_time_fields(), answer.rays)},
                     {"discs", json_of(shared_time_fields(), answer.discs)}};
       }}};
  return fields;
}

const Fields<ChooseAnswer>& choose_fields() {
  static const Fields<ChooseAnswer> fields = [] {
    using Of = Field<ChooseAnswer>;
    const auto analysed = [](auto value) { return of_part(&ChooseAnswer::analysis, value); };
    const auto of_job = [](const char* key) {
      return [key](const ChooseAnswer& answer) {
        const Json all = answer.job ? ledgers_json(*answer.job) : Json::object();
        return all.contains(key) ? all[key] : left_out();
      };
    };
    const Fields<ChooseAnswer> in_tables{
        {"tried", "", "candidates that were run", analysed(&Analysis::tried)},
        {"regret", "", "measured time of the predicted choice over the shortest, minus 1",
         analysed([](const Analysis& one) { return if_any(one.regret); })},
        {"regret_error", "", "half the ranges of both times, together, over the shortest",
         analysed([](const Analysis& one) { return one.regret ? Json(one.regret_error) : left_out(); })},
        {"rigor", "", "how the choice was made", [](const ChooseAnswer& answer) { return name(answer.rigor); }},
        {"unit_costs", "", "where they come from", &ChooseAnswer::costs_origin},
        Of("choosing_seconds", "s", "total, and its parts: evidence for effects, pilot; evidence that is only shown",
           [](const ChooseAnswer& answer) {
             return Json{{"total", answer.choosing_seconds},
                         {"evidence", answer.evidence_seconds},
                         {"evidence_shown", answer.shown_evidence_seconds},
                         {"pilot", answer.by_sample() ? answer.choice.choosing_seconds : 0}};
           })
            .in({{"choosing_seconds", "/total"}}),
        Of("whole", "s", "predicted time of detp run with the predicted choice, by part",
           [](const ChooseAnswer& answer) { return whole_json(answer.whole.seconds); })
            .in({{"whole_seconds", "/total"}}),
        {"peak_bytes", "bytes", "predicted memory of that run",
         [](const ChooseAnswer& answer) { return answer.whole.peak_bytes; }}};
    const Fields<ChooseAnswer> others{
        {"choice", "", "the fastest candidate: measured, else predicted",
         [](const ChooseAnswer& answer) {
           const std::vector<ChooseRow> rows = rows_of(answer);
           return json_of(row_fields({"technique", "parameters", "threads", "predicted_seconds",
                                      "predicted_seconds_again", "predicted_seconds_error", "extrapolated",
                                      "extrapolated_because", "measured_seconds", "measured_spread"}),
                          *std::ranges::find_if(rows, &ChooseRow::chosen));
         }},
        {"candidates", "", "in the order of the ranking, then others that were tried",
         [](const ChooseAnswer& answer) { return jsons_of(rows_of(answer), choose_row_fields()); }},
        {"paper_rule", "", "what the paper's rule takes",
         [](const ChooseAnswer& answer) {
           return json_of(row_fields({"technique", "parameters", "threads", "predicted_seconds", "extrapolated",
                                      "extrapolated_because"}),
                          paper_row(answer));
         }},
        {"predicted_choice", "", "with --analyze: the choice before the runs",
         [](const ChooseAnswer& answer) {
           return answer.analysis ? json_of(row_fields({"technique", "parameters", "threads", "predicted_seconds",
                                                        "predicted_seconds_again"}),
                                            rows_of(answer).front())
                                  : left_out();
         }},
        {"best_measured", "", "with --analyze: the candidate with the shortest measured time",
         [](const ChooseAnswer& answer) {
           return answer.fastest() != nullptr
                      ? json_of(
                            row_fields({"technique", "parameters", "threads", "measured_seconds", "measured_spread"}),
                            rows_of(answer)[*answer.analysis->best])
                      : left_out();
         }},
        {"missed", "", "errors of the predictions of the predicted choice and of the fastest candidate",
         [](const ChooseAnswer& answer) {
           return answer.fastest() != nullptr ? jsons_of(explained_rows(answer), missed_fields()) : left_out();
         }},
        {"stopped", "", "a stop request ended the runs", analysed(&Analysis::stopped)},
        {"ruled_out", "", "techniques that were not tried, because they are slower",
         [](const ChooseAnswer& answer) {
           return answer.by_sample() ? list_json(answer.choice.ruled_out, ruled_out_fields()) : left_out();
         }},
        {"not_examined", "", "techniques about which finding out would take longer than it could save",
         [](const ChooseAnswer& answer) {
           return answer.by_sample() ? names_json(answer.choice.unexamined) : left_out();
         }},
        {"tips", "", "changes of one input that change the choice",
         [](const ChooseAnswer& answer) { return list_json(answer.tips.tips, tip_fields()); }},
        {"tips_range", "", "least and largest values of each input that were examined", tips_range},
        {"tips_seconds", "s", "for finding the tips", &ChooseAnswer::tips_seconds},
        {"effects", "", "what predictions take into account, and why",
         [](const ChooseAnswer& answer) { return to_json(answer.effects); }},
        {"engine", "", "simd or plain", [](const ChooseAnswer& answer) { return name(answer.costs.engine); }},
        {"choosing_share", "", "time for choosing over the predicted time of the choice",
         [](const ChooseAnswer& answer) { return answer.choosing_seconds / answer.choice.best().seconds(); }},
        {"warnings", "", "notices and warnings about rays and discs",
         [](const ChooseAnswer& answer) { return answer.job ? answer.job->all_said() : std::vector<std::string>{}; }},
        {"light", "", "where traced photons went", of_job("light")},
        {"geometry", "", "what was done to the mesh's faces", of_job("geometry")},
        {"ranks", "", "what processes that share the run take",
         of_part(&ChooseAnswer::ranks, [](const RanksAnswer& ranks) { return json_of(ranks_fields(), ranks); })}};
    Fields<ChooseAnswer> all = in_tables;
    for (const Of& field : others) all.push_back(field.in_json_alone());
    return all;
  }();
  return fields;
}

}  // namespace detp::validate
