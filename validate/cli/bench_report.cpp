#include "bench_report.hpp"

#include <fmt/format.h>

#include "table.hpp"
#include "workload_options.hpp"

namespace detp::cli {
namespace {

using validate::AgainstEmbree;
using validate::BenchEntry;
using validate::BenchResult;
using validate::BenchWorkload;
using validate::Finish;

std::string radius_text(const BenchWorkload& workload) {
  const validate::Length& radius = workload.disc_radius;
  return radius.relative ? fmt::format("{:g}%", 100 * radius.value) : fmt::format("{:g}", radius.value);
}

std::string describe(const BenchWorkload& workload) {
  return fmt::format("{}, {}, {:g} rays{}, radius {}", workload.scene, name(workload.field), workload.rays,
                     workload.samples ? fmt::format(", {:g} samples", *workload.samples) : "", radius_text(workload));
}

Json workload_json(const BenchEntry& entry) {
  return {{"scene", entry.workload.scene},      {"field", name(entry.workload.field)},
          {"rays", whole(entry.workload.rays)}, {"samples", whole(entry.samples)},
          {"disc_radius", entry.disc_radius},   {"threads", entry.threads}};
}

Json parameters_json(const validate::Competitor& competitor) {
  if (const auto* ours = std::get_if<Candidate>(&competitor)) return to_json(*ours);
  const auto& mode = std::get<validate::EmbreeMode>(competitor);
  return {{"call", call_of(mode)}, {"quality", validate::name(mode.quality)}, {"coherent", mode.coherent}};
}

Json row_json(const BenchEntry& entry, const Finish& finish) {
  Json json = workload_json(entry);
  json.update({{"technique", technique_of(finish.competitor)},
               {"parameters", parameters_json(finish.competitor)},
               {"seconds", finish.median_seconds()},
               {"runs", finish.seconds.size()},
               {"hits", finish.hits},
               {"wrong_hits", finish.wrong_hits},
               {"right_hits_by", name(entry.judge)}});
  return json;
}

Json side_json(const Finish& finish) {
  return {{"technique", technique_of(finish.competitor)},
          {"parameters", parameters_json(finish.competitor)},
          {"seconds", finish.median_seconds()}};
}

Json worst_json(const BenchEntry& entry) {
  Json json = workload_json(entry);
  json["ours"] = side_json(*entry.best(true));
  json["embree"] = side_json(*entry.best(false));
  return json;
}

Json to_json(const AgainstEmbree& summary, const BenchResult& bench) {
  return {{"threads", summary.threads},
          {"races", summary.races},
          {"geometric_mean", summary.geometric_mean},
          {"worst", summary.worst},
          {"worst_row", worst_json(bench.entries[summary.worst_entry])}};
}

/// The summary for the first number of threads at the top level, as the contract requires, and for each number in a
/// list.
Json summary_json(const BenchResult& bench, const validate::BenchOptions& options) {
  Json all = Json::array();
  for (const int threads : options.threads)
    if (const auto summary = validate::against_embree(bench.entries, threads)) all.push_back(to_json(*summary, bench));
  const validate::WrongHits wrong = validate::embree_wrong_hits(bench.entries);
  Json json = Json::object();
  if (!all.empty()) {
    json["against_embree"] = all.front();
    json["against_embree"]["by_threads"] = all;
  }
  json["ours_agree"] = validate::ours_agree(bench.entries);
  json["embree_hits"] = wrong.hits;
  json["embree_wrong_hits"] = wrong.wrong;
  return json;
}

std::string side_text(const Finish* finish, std::size_t name_width) {
  if (finish == nullptr) return fmt::format("{:<{}} {:>9}", "", name_width, "");
  std::string name = parameters_of(finish->competitor);
  if (validate::is_ours(finish->competitor)) name = fmt::format("{} {}", technique_of(finish->competitor), name);
  return fmt::format("{:<{}} {:>9.3g}", name, name_width, finish->median_seconds());
}

std::string line_of(const BenchEntry& entry) {
  const double ratio = entry.ratio();
  return fmt::format("{:<15} {:<9} {:>5.0e} {:>7.0f} {:>6} {:>3}  {}  {}  {}\n", entry.workload.scene,
                     name(entry.workload.field), entry.workload.rays, entry.samples, radius_text(entry.workload),
                     entry.threads, side_text(entry.best(true), 37), side_text(entry.best(false), 33),
                     ratio > 0 ? fmt::format("{:>6.2f}", ratio) : "stopped");
}

std::string summary_text(const BenchResult& bench, const validate::BenchOptions& options) {
  std::string text;
  for (const int threads : options.threads)
    if (const auto summary = validate::against_embree(bench.entries, threads)) {
      const BenchEntry& worst = bench.entries[summary->worst_entry];
      text +=
          fmt::format("\n{} thread{}: {} races, Embree takes {:.3g} times as long (geometric mean), at worst {:.3g}\n",
                      threads, threads == 1 ? "" : "s", summary->races, summary->geometric_mean, summary->worst);
      text += fmt::format("  worst: {}: {} {:.3g} s, Embree {} {:.3g} s\n", describe(worst.workload),
                          technique_of(worst.best(true)->competitor), worst.best(true)->median_seconds(),
                          parameters_of(worst.best(false)->competitor), worst.best(false)->median_seconds());
    }
  const validate::WrongHits wrong = validate::embree_wrong_hits(bench.entries);
  text += fmt::format("\nhits: ours {}; Embree, in single precision, is wrong about {} of {}\n",
                      validate::ours_agree(bench.entries) ? "all agree" : "DO NOT AGREE", wrong.wrong, wrong.hits);
  return text;
}

std::string left_out_text(const BenchResult& bench, const std::vector<std::string>& missing) {
  std::string text;
  for (const std::string& why : missing) text += fmt::format("left out  {}\n", why);
  for (const validate::BenchSkip& skip : bench.skipped)
    text += fmt::format("skipped   {}: {}\n", describe(skip.workload), skip.why);
  return text.empty() ? text : "\n" + text;
}

std::string to_text(const BenchResult& bench, const validate::BenchOptions& options,
                    const std::vector<std::string>& missing) {
  std::string text =
      fmt::format("{:<15} {:<9} {:>5} {:>7} {:>6} {:>3}  {:<37} {:>9}  {:<33} {:>9}  {:>6}\n", "scene", "field", "rays",
                  "discs", "radius", "thr", "best of ours", "seconds", "Embree's best", "seconds", "times");
  for (const BenchEntry& entry : bench.entries) text += line_of(entry);
  return text + summary_text(bench, options) + left_out_text(bench, missing);
}

/// Marks the best technique of each race: `best` is "ours" or "embree".
std::string to_csv(const BenchResult& bench) {
  Table table(Columns{"scene", "field", "rays", "samples", "disc_radius", "threads"} + candidate_columns() +
              Columns{"call", "coherent", "seconds", "runs", "hits", "wrong_hits", "right_hits_by", "best"});
  for (const BenchEntry& entry : bench.entries)
    for (const Finish& finish : entry.race.finishes) {
      Json row = row_json(entry, finish);
      const Json parameters = row["parameters"];
      row["parameters"] = parameters_of(finish.competitor);
      row.update(parameters);
      if (&finish == entry.best(true)) row["best"] = "ours";
      if (&finish == entry.best(false)) row["best"] = "embree";
      table.add(row);
    }
  return table.csv();
}

}  // namespace

Result report_bench(const BenchResult& bench, const validate::BenchOptions& options,
                    const std::vector<std::string>& missing) {
  Result result;
  Json rows = Json::array();
  for (const BenchEntry& entry : bench.entries)
    for (const Finish& finish : entry.race.finishes) rows.push_back(row_json(entry, finish));
  Json skipped = Json::array();
  for (const validate::BenchSkip& skip : bench.skipped)
    skipped.push_back({{"workload", describe(skip.workload)}, {"why", skip.why}});
  result.json = {{"rows", std::move(rows)},
                 {"summary", summary_json(bench, options)},
                 {"skipped", std::move(skipped)},
                 {"left_out", missing}};
  result.text = to_text(bench, options, missing);
  result.csv = to_csv(bench);
  if (!validate::ours_agree(bench.entries)) result.code = ExitCode::refuted;
  if (bench.stopped) result.stopped = {bench.done, bench.workloads, "workloads"};
  return result;
}

}  // namespace detp::cli
