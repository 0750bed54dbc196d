#include "bench_report.hpp"

#include <fmt/format.h>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/validate/cli/report/answer_rows.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/table.hpp"

namespace detp::cli {
namespace {

using validate::AgainstEmbree;
using validate::BenchEntry;
using validate::BenchResult;
using validate::BenchWorkload;
using validate::CompetitorResult;

std::string radius_text(const BenchWorkload& workload) {
  const validate::Length& radius = workload.disc_radius;
  return radius.relative ? fmt::format("{:g}%", 100 * radius.value) : fmt::format("{:g}", radius.value);
}

std::string title_of(const BenchWorkload& workload) {
  return fmt::format("{}, {}, {:g} rays{}, radius {}", workload.scene, name(workload.field), workload.rays,
                     workload.samples ? fmt::format(", {:g} samples", *workload.samples) : "", radius_text(workload));
}

Json workload_json(const BenchEntry& entry) {
  return {{"scene", entry.workload.scene},           {"field", name(entry.workload.field)},
          {"rays", whole(entry.workload.rays)},      {"samples", whole(entry.samples)},
          {"disc_radius", entry.disc_radius},        {"threads", entry.threads},
          {"instruction_set", entry.instruction_set}};
}

Json parameters_json(const validate::Competitor& competitor) {
  if (const auto* ours = std::get_if<Candidate>(&competitor)) return to_json(*ours);
  if (!validate::is_embree(competitor)) return Json::object();
  const auto& mode = std::get<validate::EmbreeMode>(competitor);
  return {{"call", call_of(mode)}, {"quality", validate::name(mode.quality)}, {"coherent", mode.coherent}};
}

Json row_json(const BenchEntry& entry, const CompetitorResult& competitor_result) {
  Json json = workload_json(entry);
  json.update({{"technique", technique_of(competitor_result.competitor)},
               {"parameters", parameters_json(competitor_result.competitor)},
               {"seconds", competitor_result.median_seconds()},
               {"runs", competitor_result.seconds.size()},
               {"hits", competitor_result.hits},
               {"wrong_hits", competitor_result.wrong_hits},
               {"right_hits_by", name(entry.judge)}});
  return json;
}

Json side_json(const CompetitorResult& competitor_result) {
  return {{"technique", technique_of(competitor_result.competitor)},
          {"parameters", parameters_json(competitor_result.competitor)},
          {"seconds", competitor_result.median_seconds()}};
}

Json worst_json(const BenchEntry& entry) {
  Json json = workload_json(entry);
  json["ours"] = side_json(*entry.best(true));
  json["embree"] = side_json(*entry.best(false));
  return json;
}

/// `choice` has the figures of our choice: null if it did not take part.
Json embree_json(const AgainstEmbree& summary, const BenchResult& bench) {
  Json json{{"threads", summary.threads},
            {"races", summary.races},
            {"geometric_mean", summary.geometric_mean},
            {"worst", summary.worst},
            {"worst_row", worst_json(bench.entries[summary.worst_entry])},
            {"choice", nullptr}};
  if (const auto chosen = validate::against_embree(bench.entries, summary.threads, validate::Ours::choice))
    json["choice"] = {{"races", chosen->races},
                      {"geometric_mean", chosen->geometric_mean},
                      {"worst", chosen->worst},
                      {"kept", validate::kept_by_choice(bench.entries, summary.threads)}};
  return json;
}

/// `against_embree` has the summary for the first number of threads, and in `by_threads` the summaries for all numbers.
Json summary_json(const BenchResult& bench, const validate::BenchOptions& options) {
  Json all = Json::array();
  for (const int threads : options.threads)
    if (const auto summary = validate::against_embree(bench.entries, threads))
      all.push_back(embree_json(*summary, bench));
  const validate::WrongHits wrong = validate::embree_wrong_hits(bench.entries);
  Json json = Json::object();
  if (!all.empty()) {
    json["against_embree"] = all.front();
    json["against_embree"]["by_threads"] = all;
  }
  json["ours_agree"] = validate::do_own_hits_agree(bench.entries);
  json["embree_hits"] = wrong.hits;
  json["embree_wrong_hits"] = wrong.wrong;
  return json;
}

std::vector<TextCell> side_cells(const CompetitorResult* competitor_result, Style style) {
  if (competitor_result == nullptr) return {{}, {}};
  std::string name = parameters_of(competitor_result->competitor);
  if (validate::is_own_technique(competitor_result->competitor))
    name = fmt::format("{}{}{}", technique_of(competitor_result->competitor), name.empty() ? "" : ", ", name);
  return {{std::move(name), style}, {fmt::format("{:.3g}", competitor_result->median_seconds()), style}};
}

std::vector<TextCell> row_of(const BenchEntry& entry) {
  const double ratio = entry.ratio();
  std::vector<TextCell> cells{{escaped(entry.workload.scene)},
                              {std::string(name(entry.workload.field))},
                              {fmt::format("{:g}", entry.workload.rays)},
                              {fmt::format("{:.0f}", entry.samples)},
                              {radius_text(entry.workload)},
                              {fmt::format("{}", entry.threads)}};
  for (const bool ours : {true, false})
    for (TextCell& cell : side_cells(entry.best(ours), Style::plain)) cells.push_back(std::move(cell));
  cells.push_back(ratio > 0 ? TextCell{fmt::format("{:.2f}", ratio), ratio >= 1 ? Style::good : Style::bad}
                            : TextCell{"stopped", Style::doubtful});
  return cells;
}

std::string table_text(const BenchResult& bench, const Screen& screen) {
  TextTable table({{.head = "scene", .align = Align::left},
                   {.head = "field", .align = Align::left},
                   {.head = "rays"},
                   {.head = "discs", .spare = 1},
                   {.head = "radius"},
                   {.head = "threads"},
                   {.head = "technique", .align = Align::left, .spare = 2, .group = "best of ours"},
                   {.head = "seconds", .group = "best of ours"},
                   {.head = "call", .align = Align::left, .spare = 3, .group = "Embree's best"},
                   {.head = "seconds", .group = "Embree's best"},
                   {.head = "times"}});
  for (const BenchEntry& entry : bench.entries) table.add(row_of(entry));
  return table.text(screen) +
         legend(screen,
                "seconds: median of the rounds, from discs and rays in memory to irradiance in memory, building "
                "included. times: Embree's seconds over ours. radius: of the discs, % of the scene's longest side.");
}

std::string summary_text(const BenchResult& bench, const validate::BenchOptions& options, const Screen& screen) {
  std::string text;
  const auto add = [&](const std::string& line) { text += wrapped(line, screen.text_width(), 4); };
  if (!bench.entries.empty() && !options.instruction_set.empty())
    text += "\n" + bench.entries.front().instruction_set + "\n";
  for (const int threads : options.threads)
    if (const auto summary = validate::against_embree(bench.entries, threads)) {
      const BenchEntry& worst = bench.entries[summary->worst_entry];
      text += "\n";
      add(fmt::format("{} thread{}: {} race{}, Embree takes {:.3g} times as long (geometric mean), at worst {:.3g}",
                      threads, threads == 1 ? "" : "s", summary->races, summary->races == 1 ? "" : "s",
                      summary->geometric_mean, summary->worst));
      add(fmt::format("  worst: {}: {} {:.3g} s, Embree {} {:.3g} s", title_of(worst.workload),
                      technique_of(worst.best(true)->competitor), worst.best(true)->median_seconds(),
                      parameters_of(worst.best(false)->competitor), worst.best(false)->median_seconds()));
      if (const auto chosen = validate::against_embree(bench.entries, threads, validate::Ours::choice))
        add(fmt::format(
            "  our choice, with choosing: {:.3g} times (geometric mean), at worst {:.3g}; it keeps {:.3g} % "
            "of what the best gains",
            chosen->geometric_mean, chosen->worst, 100 * validate::kept_by_choice(bench.entries, threads)));
    }
  const validate::WrongHits wrong = validate::embree_wrong_hits(bench.entries);
  const bool agree = validate::do_own_hits_agree(bench.entries);
  text += fmt::format("\nhits: ours {}; Embree, in single precision, is wrong about {} of {}\n",
                      styled(screen, agree ? Style::good : Style::bad, agree ? "all agree" : "DO NOT AGREE"),
                      wrong.wrong, wrong.hits);
  return text;
}

std::string left_out_text(const BenchResult& bench, const std::vector<std::string>& missing, const Screen& screen) {
  std::string text;
  const auto add = [&](const std::string& line) { text += wrapped(line, screen.text_width(), 10); };
  for (const std::string& why : missing) add(fmt::format("left out  {}", why));
  for (const validate::BenchSkip& skip : bench.skipped)
    add(fmt::format("skipped   {}: {}", title_of(skip.workload), skip.why));
  return text.empty() ? text : "\n" + text;
}

std::string to_text(std::span<const BenchResult> benches, const validate::BenchOptions& options,
                    const std::vector<std::string>& missing, const Screen& screen) {
  std::string text;
  for (const BenchResult& bench : benches)
    text += (text.empty() ? "" : "\n") + table_text(bench, screen) + summary_text(bench, options, screen);
  return text + left_out_text(benches.front(), missing, screen);
}

/// `best` is "ours" in the row of our fastest technique, "embree" in that of Embree's fastest mode.
std::string to_csv(std::span<const BenchResult> benches) {
  Table table(
      Columns{"scene", "field", "rays", "samples", "disc_radius", "threads"} + candidate_columns() +
      Columns{"call", "coherent", "seconds", "runs", "hits", "wrong_hits", "right_hits_by", "best", "instruction_set"});
  for (const BenchResult& bench : benches)
    for (const BenchEntry& entry : bench.entries)
      for (const CompetitorResult& competitor_result : entry.race.results) {
        Json row = row_json(entry, competitor_result);
        const Json parameters = row["parameters"];
        row["parameters"] = parameters_of(competitor_result.competitor);
        row.update(parameters);
        if (&competitor_result == entry.best(true)) row["best"] = "ours";
        if (&competitor_result == entry.best(false)) row["best"] = "embree";
        table.add(row);
      }
  return table.csv();
}

}  // namespace

Result report_bench(std::span<const BenchResult> benches, const validate::BenchOptions& options,
                    const std::vector<std::string>& missing, const Screen& screen) {
  Result result;
  Json rows = Json::array();
  Json summaries = Json::array();
  bool agree = true;
  for (const BenchResult& bench : benches) {
    for (const BenchEntry& entry : bench.entries)
      for (const CompetitorResult& competitor_result : entry.race.results)
        rows.push_back(row_json(entry, competitor_result));
    summaries.push_back(summary_json(bench, options));
    if (!bench.entries.empty()) summaries.back()["instruction_set"] = bench.entries.front().instruction_set;
    agree = agree && validate::do_own_hits_agree(bench.entries);
    if (bench.stopped) result.stopped = {bench.done, bench.workloads, "workloads"};
  }
  Json skipped = Json::array();
  for (const validate::BenchSkip& skip : benches.front().skipped)
    skipped.push_back({{"workload", title_of(skip.workload)}, {"why", skip.why}});
  result.json = {{"rows", std::move(rows)},
                 {"summary", summaries.front()},
                 {"skipped", std::move(skipped)},
                 {"left_out", missing}};
  if (benches.size() > 1) result.json["summary"]["by_instruction_set"] = std::move(summaries);
  result.text = to_text(benches, options, missing, screen);
  result.csv = to_csv(benches);
  if (!agree) result.code = ExitCode::refuted;
  return result;
}

}  // namespace detp::cli
