#include "bench_answer.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

#include "detp/sim/lists/simd/instruction_sets.hpp"

namespace detp::validate {
namespace {

std::vector<int> threads_of(int asked) {
  if (asked > 0) return {asked};
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  return cores > 1 ? std::vector{1, cores} : std::vector{1};
}

Json competitor_json(const Competitor& competitor) {
  if (const auto* ours = std::get_if<Candidate>(&competitor)) return to_json(*ours);
  if (!is_embree(competitor)) return Json::object();
  const auto& mode = std::get<EmbreeMode>(competitor);
  return {{"call", call_of(mode)}, {"quality", name(mode.quality)}, {"coherent", mode.coherent}};
}

const Fields<BenchEntry>& workload_fields() {
  using Entry = BenchEntry;
  static const Fields<Entry> fields{
      {"scene", "", "its name", [](const Entry& entry) { return entry.workload.scene; }},
      {"field", "", "isotropic lines, or photon paths", [](const Entry& entry) { return name(entry.workload.field); }},
      {"rays", "", "number that was asked for", [](const Entry& entry) { return whole(entry.workload.rays); }},
      {"samples", "", "number of discs", [](const Entry& entry) { return whole(entry.samples); }},
      {"disc_radius", "scene units", "of the discs", &Entry::disc_radius},
      {"threads", "", "of each run", &Entry::threads}};
  return fields;
}

const Fields<BenchEntry>& instruction_set_fields() {
  static const Fields<BenchEntry> fields{{"instruction_set", "", "of our kernels", &BenchEntry::instruction_set}};
  return fields;
}

const Fields<CompetitorResult>& side_fields() {
  using Result = CompetitorResult;
  static const Fields<Result> fields{
      {"technique", "", "ours; embree; or choice: what detp run chooses, choosing included",
       [](const Result& result) { return technique_of(result.competitor); }},
      Field<Result>("parameters", "", "as text", [](const Result& result) { return parameters_of(result.competitor); })
          .in_tables_alone(),
      Field<Result>("parameters", "", "of the technique, or Embree's mode",
                    [](const Result& result) { return competitor_json(result.competitor); })
          .in(parameter_columns({"call", "coherent"})),
      {"seconds", "s", "median of the runs, from discs and rays in memory to irradiance in memory",
       &Result::median_seconds}};
  return fields;
}

/// What summaries show of the entry where we are worst.
Json worst_json(const BenchEntry& entry) {
  Json json = json_of(workload_fields() + instruction_set_fields(), entry);
  json["ours"] = json_of(side_fields(), *entry.best(true));
  json["embree"] = json_of(side_fields(), *entry.best(false));
  return json;
}

/// `choice` has the figures of our choice: null if it did not take part.
Json embree_json(const AgainstEmbree& summary, std::span<const BenchEntry> entries) {
  Json json{{"threads", summary.threads},
            {"races", summary.races},
            {"geometric_mean", summary.geometric_mean},
            {"worst", summary.worst},
            {"worst_row", worst_json(entries[summary.worst_entry])},
            {"choice", nullptr}};
  if (const auto chosen = against_embree(entries, summary.threads, Ours::choice))
    json["choice"] = {{"races", chosen->races},
                      {"geometric_mean", chosen->geometric_mean},
                      {"worst", chosen->worst},
                      {"kept", chosen->kept}};
  return json;
}

/// `against_embree` has the summary for the first number of threads, and in `by_threads` the summaries for all numbers.
Json races_json(std::span<const BenchEntry> entries, const std::vector<int>& threads) {
  Json all = Json::array();
  for (const int number : threads)
    if (const auto summary = against_embree(entries, number)) all.push_back(embree_json(*summary, entries));
  const WrongHits wrong = embree_wrong_hits(entries);
  Json json{
      {"ours_agree", do_own_hits_agree(entries)}, {"embree_hits", wrong.hits}, {"embree_wrong_hits", wrong.wrong}};
  if (!all.empty()) {
    json["against_embree"] = all.front();
    json["against_embree"]["by_threads"] = all;
  }
  if (!entries.empty()) json["instruction_set"] = entries.front().instruction_set;
  return json;
}

/// That of the first instruction set; if there are several, all in `by_instruction_set`.
Json all_races_json(const BenchAnswer& answer) {
  Json all = Json::array();
  for (const BenchResult& bench : answer.benches) all.push_back(races_json(bench.entries, answer.options.threads));
  Json json = all.front();
  if (all.size() > 1) json["by_instruction_set"] = std::move(all);
  return json;
}

}  // namespace

BenchAnswer answer(const BenchRequest& request, const std::stop_token& stop, const sim::ReportPhase& progress,
                   const Notice& notice) {
  const bool thorough = request.effort == BenchEffort::thorough;
  BenchAnswer answer{.set = bench_set(request.effort, request.axes, request.scene_folder),
                     .options = {.race = {.repeats = request.repeats,
                                          .most_seconds = thorough ? 2.0 : 0.5,
                                          .stop = stop,
                                          .progress = progress},
                                 .techniques = request.techniques,
                                 .embree_modes = request.embree_modes,
                                 .threads = threads_of(request.threads),
                                 .most_hits = request.most_hits.value_or(thorough ? 5e6 : 1e6),
                                 .seed = request.seed}};
  for (const std::string& instruction_set : request.instruction_sets) {
    answer.options.instruction_set = instruction_set;
    if (request.costs) {
      std::optional<sim::stream::OnlyInstructionSet> used;  // whose unit costs are looked for
      if (!instruction_set.empty()) used.emplace(instruction_set);
      answer.options.race.costs = costs_in_use(*request.costs, notice).simd;
    }
    answer.benches.push_back(run_bench(answer.set.workloads, answer.options));
  }
  return answer;
}

std::vector<BenchRow> bench_rows(const BenchAnswer& answer) {
  std::vector<BenchRow> rows;
  for (const BenchResult& bench : answer.benches)
    for (const BenchEntry& entry : bench.entries)
      for (const CompetitorResult& result : entry.race.results) rows.push_back({&entry, &result});
  return rows;
}

const Fields<BenchRow>& bench_row_fields() {
  static const auto entry = [](const BenchRow& row) -> const BenchEntry& { return *row.entry; };
  static const auto result = [](const BenchRow& row) -> const CompetitorResult& { return *row.result; };
  static const Fields<BenchRow> own{
      {"runs", "", "number", [](const BenchRow& row) { return row.result->seconds.size(); }},
      {"hits", "", "on all discs", [](const BenchRow& row) { return row.result->hits; }},
      {"wrong_hits", "", "sum over the discs, the most of any run",
       [](const BenchRow& row) { return row.result->wrong_hits; }},
      {"right_hits_by", "", "the technique whose hits count as right",
       [](const BenchRow& row) { return name(row.entry->judge); }},
      Field<BenchRow>("best", "", "ours: our fastest technique in this race; embree: Embree's fastest mode",
                      [](const BenchRow& row) {
                        if (row.result == row.entry->best(true)) return Json("ours");
                        return row.result == row.entry->best(false) ? Json("embree") : left_out();
                      })
          .in_tables_alone()};
  static const Fields<BenchRow> fields = fields_of_part<BenchRow>(workload_fields(), entry) +
                                         fields_of_part<BenchRow>(side_fields(), result) + own +
                                         fields_of_part<BenchRow>(instruction_set_fields(), entry);
  return fields;
}

const Fields<BenchAnswer>& bench_fields() {
  static const Fields<BenchAnswer> fields{
      {"rows", "", "a row for each competitor in each race",
       [](const BenchAnswer& answer) { return rows_json(bench_row_fields(), bench_rows(answer)); }},
      {"summary", "", "Embree's seconds over ours, over all races, and whether hits agree", all_races_json},
      {"skipped", "", "workloads that were not raced, and why",
       [](const BenchAnswer& answer) { return skipped_json(answer.benches.front()); }},
      {"left_out", "", "scenes whose files are missing", [](const BenchAnswer& answer) { return answer.set.missing; }}};
  return fields;
}

std::vector<FieldText> describe_bench() {
  return describe_fields(bench_fields()) + describe_fields(bench_row_fields());
}

std::optional<AgainstEmbree> against_embree(std::span<const BenchEntry> entries, int threads, Ours ours) {
  AgainstEmbree summary{.threads = threads};
  double logarithms = 0;
  double kept = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::optional<double> ratio = entries[i].ratio(ours);
    if (entries[i].threads != threads || !ratio) continue;
    if (summary.races == 0 || *ratio < summary.worst) {
      summary.worst = *ratio;
      summary.worst_entry = i;
    }
    ++summary.races;
    logarithms += std::log(*ratio);
    kept += std::log(*ratio / entries[i].ratio().value());
  }
  if (summary.races == 0) return std::nullopt;
  summary.geometric_mean = std::exp(logarithms / static_cast<double>(summary.races));
  summary.kept = std::exp(kept / static_cast<double>(summary.races));
  return summary;
}

bool do_own_hits_agree(std::span<const BenchEntry> entries) {
  return std::all_of(entries.begin(), entries.end(), [](const BenchEntry& entry) {
    return std::all_of(entry.race.results.begin(), entry.race.results.end(), [](const CompetitorResult& result) {
      return is_embree(result.competitor) || result.wrong_hits == 0;
    });
  });
}

WrongHits embree_wrong_hits(std::span<const BenchEntry> entries) {
  WrongHits sum;
  for (const BenchEntry& entry : entries)
    for (const CompetitorResult& result : entry.race.results)
      if (is_embree(result.competitor)) {
        sum.wrong += result.wrong_hits;
        sum.hits += result.hits;
      }
  return sum;
}

}  // namespace detp::validate
