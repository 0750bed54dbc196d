#include "regret_answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <thread>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/lists/simd/instruction_sets.hpp"

namespace detp::validate {
namespace {

/// Leaves only the workloads of this scene.
void keep_scene(std::vector<BenchWorkload>& workloads, const std::string& scene) {
  std::vector<std::string_view> names;
  for (const BenchWorkload& one : workloads)
    if (names.empty() || names.back() != one.scene) names.emplace_back(one.scene);
  if (std::ranges::find(names, scene) == names.end())
    throw std::invalid_argument(fmt::format("bench --regret has no scene {} at this effort; there are {}{}",
                                            detp::quoted(scene), fmt::join(names, ", "), did_you_mean(scene, names)));
  std::erase_if(workloads, [&](const BenchWorkload& one) { return one.scene != scene; });
}

void keep_fields(std::vector<BenchWorkload>& workloads, const std::vector<sim::Field>& fields) {
  std::erase_if(workloads,
                [&](const BenchWorkload& one) { return std::ranges::find(fields, one.field) == fields.end(); });
  if (!workloads.empty()) return;
  std::vector<std::string_view> names;
  for (const sim::Field field : fields) names.push_back(name(field));
  throw std::invalid_argument(fmt::format("no workload of these scenes has the field {}", fmt::join(names, ",")));
}

BenchSet set_of(const RegretRequest& request) {
  BenchSet set = request.families ? BenchSet{family_workloads(*request.families), {}}
                                  : regret_set(request.effort, request.scene_folder);
  if (request.scene) keep_scene(set.workloads, *request.scene);
  if (!request.fields.empty()) keep_fields(set.workloads, request.fields);
  return set;
}

/// Null without ratios.
Field<Figures> figure(const char* name, const char* meaning, double Figures::*value) {
  return {name, "", meaning, [value](const Figures& one) { return one.rows > 0 ? Json(one.*value) : Json(); }};
}

Json figures_json(const Figures& figures) {
  static const Fields<Figures> fields{{"workloads", "", "number", &Figures::rows},
                                      figure("geometric_mean", "of the ratios", &Figures::geometric_mean),
                                      figure("p95", "their quantile 0.95", &Figures::p95),
                                      figure("worst", "the largest", &Figures::worst),
                                      {"at_least", "", "number of ratios that are lower bounds", &Figures::at_least}};
  return json_of(fields, figures);
}

/// The figures over all workloads, and those of the halves under `fitted` and `held_out`.
Json figures_json(const RegretFigures& figures) {
  Json json = figures_json(figures.all);
  json["fitted"] = figures_json(figures.fitted);
  json["held_out"] = figures_json(figures.held_out);
  return json;
}

Json regrets_json(const RegretSummary& summary) {
  Json json = Json::object();
  for (const TierSummary& tier : summary.tiers) json[tier.tier] = figures_json(tier.regret);
  for (std::size_t i = 0; i < summary.baselines.size(); ++i) {
    Json one = figures_json(summary.baselines[i].regret);
    if (const auto candidate = candidate_of(i, summary.baselines[i])) {
      one["technique"] = name(candidate->technique);
      one["parameters"] = to_json(*candidate);
    }
    json[std::string(baselines()[i].name)] = std::move(one);
  }
  return json;
}

Json prediction_json(const PredictionFigures& prediction) {
  const auto error = [&](double value) { return prediction.rows > 0 ? Json(value) : Json(); };
  return {{"workloads", prediction.rows},
          {"median_error", error(prediction.median_error)},
          {"p95_error", error(prediction.p95_error)}};
}

/// `prediction` and `price` are those of the first tier; those of all tiers are in `tiers`.
Json regret_summary_json(const RegretSummary& summary) {
  Json json{{"threads", summary.threads},
            {"workloads", summary.rows},
            {"regret", regrets_json(summary)},
            {"noise", figures_json(summary.noise)}};
  Json tiers = Json::object();
  for (const TierSummary& tier : summary.tiers)
    tiers[tier.tier] = {{"price", figures_json(tier.price)}, {"prediction", prediction_json(tier.prediction)}};
  if (!summary.tiers.empty()) json.update(tiers.front());
  json["tiers"] = std::move(tiers);
  return json;
}

/// The first summary, in `by_threads` all summaries, and the `worst` choices.
Json all_regrets_json(const RegretAnswer& answer) {
  Json json = regret_summary_json(answer.summaries.front());
  json["by_threads"] = Json::array();
  for (const RegretSummary& summary : answer.summaries) json["by_threads"].push_back(regret_summary_json(summary));
  json["worst"] = rows_json(tier_fields(), worst_choices(answer.result.rows, most_worst_choices));
  return json;
}

/// The regret of a baseline, by its index, with the candidate that the summary selected; null without a summary, and if the candidate's index
/// does not fit in memory.
const Regret* regret_of_baseline(const TierRow& row, std::size_t baseline) {
  if (row.summary == nullptr) return nullptr;
  const auto& regret = row.row->baselines[baseline][row.summary->baselines[baseline].option];
  return regret ? &*regret : nullptr;
}

Fields<TierRow> baseline_fields() {
  Fields<TierRow> fields;
  for (std::size_t i = 0; i < baselines().size(); ++i) {
    const std::string name(baselines()[i].name);
    const std::string text(baselines()[i].text);
    fields.emplace_back(name + "_regret", "", "seconds of " + text + " over those of the best",
                        [i](const TierRow& row) {
                          const Regret* regret = regret_of_baseline(row, i);
                          return regret != nullptr ? Json(regret->value) : left_out();
                        });
    fields.emplace_back(name + "_abandoned", "", "whether that is a lower bound", [i](const TierRow& row) {
      const Regret* regret = regret_of_baseline(row, i);
      return regret != nullptr ? Json(regret->at_least) : left_out();
    });
  }
  return fields;
}

const Candidate& chosen_by(const TierRow& row) { return row.choice->choice.prediction.candidate; }

}  // namespace

void RegretAnswer::summarise_all() {
  summaries.clear();
  for (const int number : threads) summaries.push_back(summarise(result.rows, number));
}

RegretAnswer answer(const RegretRequest& request, const std::stop_token& stop, const sim::ReportPhase& progress,
                    const Notice& notice) {
  std::optional<sim::stream::OnlyInstructionSet> only;
  if (!request.instruction_set.empty()) only.emplace(request.instruction_set);
  RegretAnswer answer{.set = set_of(request), .costs = costs_in_use(request.costs, notice)};
  RegretOptions options{.costs = answer.costs.simd,
                        .threads = std::max(1, request.threads),
                        .seed = request.seed,
                        .stop = stop,
                        .progress = progress};
  answer.threads = {options.threads};
  if (request.effort == BenchEffort::thorough && request.threads == 0 && std::thread::hardware_concurrency() > 1) {
    options.more_threads = 2;
    answer.threads.push_back(options.more_threads);
  }
  answer.result = run_regret(answer.set.workloads, all_choosers(answer.costs.simd), options);
  answer.summarise_all();
  return answer;
}

std::vector<TierRow> tier_rows(const RegretAnswer& answer) {
  std::vector<TierRow> rows;
  for (const RegretRow& row : answer.result.rows)
    for (const RegretSummary& summary : answer.summaries)
      if (row.threads == summary.threads)
        for (const ChoiceRow& choice : row.choices) rows.push_back({&row, &choice, &summary});
  return rows;
}

const Fields<TierRow>& tier_fields() {
  using Row = TierRow;
  static const Fields<Row> of_choice{
      {"scene", "", "its name", [](const Row& row) { return row.row->workload.scene; }},
      {"held_out", "", "whether no number of a chooser was set with this scene",
       [](const Row& row) { return row.row->workload.held_out; }},
      {"field", "", "isotropic lines, or photon paths", [](const Row& row) { return name(row.row->workload.field); }},
      {"rays", "", "number, with all pieces of paths", [](const Row& row) { return whole(row.row->rays); }},
      {"samples", "", "number of discs", [](const Row& row) { return whole(row.row->samples); }},
      {"disc_radius", "scene units", "of the discs", [](const Row& row) { return row.row->disc_radius; }},
      {"threads", "", "most of a run", [](const Row& row) { return row.row->threads; }},
      {"tier", "", "the way to choose", [](const Row& row) { return row.choice->tier; }},
      {"technique", "", "that was chosen", [](const Row& row) { return name(chosen_by(row).technique); }},
      Field<Row>("parameters", "", "as text", [](const Row& row) { return describe(chosen_by(row)); })
          .in_tables_alone(),
      Field<Row>("parameters", "", "of the technique", [](const Row& row) { return to_json(chosen_by(row)); })
          .in(parameter_columns()),
      {"chosen_threads", "", "number", [](const Row& row) { return row.choice->choice.prediction.threads; }},
      {"predicted_seconds", "s", "of the choice; null: not predicted, only guessed",
       [](const Row& row) { return row.choice->choice.predicted_seconds(); }},
      {"choosing_seconds", "s", "that choosing took",
       [](const Row& row) { return row.choice->choice.choosing_seconds; }},
      {"seconds", "s", "of the choice, measured", [](const Row& row) { return row.choice->seconds; }},
      {"abandoned", "", "whether the run took too long, so that its seconds and regret are lower bounds",
       [](const Row& row) { return row.choice->regret.at_least; }},
      {"best_technique", "", "of all candidates", [](const Row& row) { return name(row.row->best.technique); }},
      Field<Row>("best_parameters", "", "as text", [](const Row& row) { return describe(row.row->best); })
          .in_tables_alone(),
      Field<Row>("best_parameters", "", "of the best", [](const Row& row) { return to_json(row.row->best); })
          .in_json_alone(),
      {"best_threads", "", "of the best", [](const Row& row) { return row.row->best_threads; }},
      {"best_seconds", "s", "of the best", [](const Row& row) { return row.row->best_seconds; }},
      {"tried", "", "number of candidates", [](const Row& row) { return row.row->tried; }},
      {"regret", "", "seconds of the choice over those of the best",
       [](const Row& row) { return row.choice->regret.value; }},
      {"noise", "", "the same of the best, timed a second time", [](const Row& row) { return row.row->noise; }}};
  static const Fields<Row> fields =
      of_choice + baseline_fields() +
      Fields<Row>{{"reason", "", "why the best was not chosen", [](const Row& row) { return row.choice->reason; }}};
  return fields;
}

const Fields<RegretAnswer>& regret_fields() {
  static const Fields<RegretAnswer> fields{
      {"rows", "", "a row for each workload, number of threads and tier",
       [](const RegretAnswer& answer) { return rows_json(tier_fields(), tier_rows(answer)); }},
      {"summary", "", "regrets, prices and errors of predictions of each tier and baseline, and the worst choices",
       all_regrets_json},
      {"skipped", "", "workloads that were not run, and why",
       [](const RegretAnswer& answer) { return skipped_json(answer.result); }},
      {"left_out", "", "scenes whose files are missing", [](const RegretAnswer& answer) { return answer.set.missing; }},
      {"unit_costs", "", "whose unit costs the choices use",
       [](const RegretAnswer& answer) { return answer.costs.origin; }}};
  return fields;
}

std::vector<FieldText> describe_regret() { return describe_fields(regret_fields()) + describe_fields(tier_fields()); }

}  // namespace detp::validate
