#include "bench_report.hpp"

#include <fmt/format.h>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/table.hpp"

namespace detp::cli {
namespace {

using validate::BenchEntry;
using validate::BenchResult;
using validate::CompetitorResult;

std::vector<TextCell> side_cells(const CompetitorResult* result) {
  if (result == nullptr) return {{}, {}};
  std::string name = parameters_of(result->competitor);
  if (validate::is_own_technique(result->competitor))
    name = fmt::format("{}{}{}", technique_of(result->competitor), name.empty() ? "" : ", ", name);
  return {{std::move(name)}, {fmt::format("{:.3g}", result->median_seconds())}};
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
    for (TextCell& cell : side_cells(entry.best(ours))) cells.push_back(std::move(cell));
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

}  // namespace

std::string left_out_text(const validate::BenchSet& set, const validate::SetProgress& progress, const Screen& screen) {
  std::string text;
  const auto add = [&](const std::string& line) { text += wrapped(line, screen.text_width(), 10); };
  for (const std::string& why : set.missing) add(fmt::format("left out  {}", why));
  for (const validate::SkippedWorkload& skip : progress.skipped)
    add(fmt::format("skipped   {}: {}", title_of(skip.workload), skip.why));
  return text;
}

Result report(const validate::BenchAnswer& answer, const Screen& screen) {
  Result result;
  result.json = json_of(validate::bench_fields(), answer);
  for (const BenchResult& bench : answer.benches) {
    result.text +=
        (result.text.empty() ? "" : "\n") + table_text(bench, screen) + summary_text(bench, answer.options, screen);
    if (!validate::do_own_hits_agree(bench.entries)) result.code = ExitCode::refuted;
    if (bench.stopped) result.stopped = {bench.done, bench.workloads, "workloads"};
  }
  const std::string left_out = left_out_text(answer.set, answer.benches.front(), screen);
  if (!left_out.empty()) result.text += "\n" + left_out;
  Table table(columns_of(validate::bench_row_fields()));
  for (const validate::BenchRow& row : bench_rows(answer)) table.add(cells_of(validate::bench_row_fields(), row));
  result.csv = table.csv();
  return result;
}

}  // namespace detp::cli
