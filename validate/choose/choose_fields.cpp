#include <algorithm>

#include "choose.hpp"
#include "detp/validate/answer/parts.hpp"

namespace detp::validate {
namespace {

/// Technique, parameters, threads, and the row's fields with these names.
Json row_json(const ChooseRow& row, std::vector<std::string_view> names) {
  names.insert(names.end(), {"technique", "parameters", "threads"});
  return json_of(only(choose_row_fields(), names), row);
}

/// The value where rays were sampled; elsewhere the field is left out.
template <class Value>
auto of_sample(Value value) {
  return [value](const ChooseAnswer& answer) { return answer.by_sample() ? value(answer) : left_out(); };
}

/// The value where something was measured; elsewhere the field is left out.
template <class Value>
auto of_measured(Value value) {
  return [value](const ChooseAnswer& answer) { return answer.fastest() != nullptr ? value(answer) : left_out(); };
}

/// Of the ledgers of light and geometry.
auto of_ledgers(const char* key) {
  return [key](const ChooseAnswer& answer) {
    const Json all = answer.job ? ledgers_json(*answer.job) : Json::object();
    return all.contains(key) ? all[key] : left_out();
  };
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
    const Fields<ChooseAnswer> in_tables{
        {"tried", "", "candidates that were run", analysed(&Analysis::tried)},
        {"regret", "", "measured time of the predicted choice over the shortest, minus 1", analysed(&Analysis::regret)},
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
           return row_json(*std::ranges::find_if(rows, &ChooseRow::chosen),
                           {"predicted_seconds", "predicted_seconds_again", "predicted_seconds_error", "extrapolated",
                            "extrapolated_because", "measured_seconds", "measured_spread"});
         }},
        {"candidates", "", "in the order of the ranking, then others that were tried",
         [](const ChooseAnswer& answer) { return rows_json(choose_row_fields(), rows_of(answer)); }},
        {"paper_rule", "", "what the paper's rule takes",
         [](const ChooseAnswer& answer) {
           return row_json(paper_row(answer), {"predicted_seconds", "extrapolated", "extrapolated_because"});
         }},
        {"predicted_choice", "", "with --analyze: the choice before the runs",
         [](const ChooseAnswer& answer) {
           return answer.analysis ? row_json(rows_of(answer).front(), {"predicted_seconds", "predicted_seconds_again"})
                                  : left_out();
         }},
        {"best_measured", "", "with --analyze: the candidate with the shortest measured time",
         of_measured([](const ChooseAnswer& answer) {
           return row_json(rows_of(answer)[*answer.analysis->best], {"measured_seconds", "measured_spread"});
         })},
        {"missed", "", "errors of the predictions of the predicted choice and of the fastest candidate",
         of_measured([](const ChooseAnswer& answer) { return rows_json(missed_fields(), explained_rows(answer)); })},
        {"stopped", "", "a stop request ended the runs", analysed(&Analysis::stopped)},
        {"ruled_out", "", "techniques that were not tried, because they are slower",
         of_sample([](const ChooseAnswer& answer) { return rows_json(ruled_out_fields(), answer.choice.ruled_out); })},
        {"not_examined", "", "techniques about which finding out would take longer than it could save",
         of_sample([](const ChooseAnswer& answer) { return names_json(answer.choice.unexamined); })},
        {"tips", "", "changes of one input that change the choice",
         [](const ChooseAnswer& answer) { return rows_json(tip_fields(), answer.tips.tips); }},
        {"tips_range", "", "least and largest values of each input that were examined", tips_range},
        {"tips_seconds", "s", "for finding the tips", &ChooseAnswer::tips_seconds},
        {"effects", "", "what predictions take into account, and why",
         [](const ChooseAnswer& answer) { return to_json(answer.effects); }},
        {"engine", "", "simd or plain", [](const ChooseAnswer& answer) { return name(answer.costs.engine); }},
        {"choosing_share", "", "time for choosing over the predicted time of the choice",
         [](const ChooseAnswer& answer) { return answer.choosing_seconds / answer.choice.best().seconds(); }},
        {"warnings", "", "notices and warnings about rays and discs",
         [](const ChooseAnswer& answer) { return answer.job ? answer.job->all_said() : std::vector<std::string>{}; }},
        {"light", "", "where traced photons went", of_ledgers("light")},
        {"geometry", "", "what was done to the mesh's faces", of_ledgers("geometry")},
        {"ranks", "", "what processes that share the run take",
         of_part(&ChooseAnswer::ranks, [](const RanksAnswer& ranks) { return json_of(ranks_fields(), ranks); })}};
    Fields<ChooseAnswer> all = in_tables;
    for (const Of& field : others) all.push_back(field.in_json_alone());
    return all;
  }();
  return fields;
}

std::vector<FieldText> describe_choose() {
  return describe_fields(choose_fields()) + describe_fields(choose_row_fields());
}

}  // namespace detp::validate
