#include "bench_report.hpp"

#include <fmt/format.h>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/table.hpp"

namespace detp::cli {
namespace {

using validate::BenchEntry;
using validate::BenchResult;
using validate::ChoiceRow;
using validate::CompetitorResult;
using validate::Figures;
using validate::RegretFigures;
using validate::RegretRow;
using validate::RegretSummary;
using validate::TierSummary;

std::vector<TextCell> side_cells(const CompetitorResult* result) {
  if (result == nullptr) return {{}, {}};
  std::string name = parameters_of(result->competitor);
  if (validate::is_own_technique(result->competitor))
    name = fmt::format("{}{}{}", technique_of(result->competitor), name.empty() ? "" : ", ", name);
  return {{std::move(name)}, {fmt::format("{:.3g}", result->median_seconds())}};
}

std::vector<TextCell> row_of(const BenchEntry& entry) {
  const std::optional<double> ratio = entry.ratio();
  std::vector<TextCell> cells{{escaped(entry.workload.scene)},
                              {std::string(name(entry.workload.field))},
                              {fmt::format("{:g}", entry.workload.rays)},
                              {fmt::format("{:.0f}", entry.samples)},
                              {radius_text(entry.workload)},
                              {fmt::format("{}", entry.threads)}};
  for (const bool ours : {true, false})
    for (TextCell& cell : side_cells(entry.best(ours))) cells.push_back(std::move(cell));
  cells.push_back(ratio ? TextCell{fmt::format("{:.2f}", *ratio), *ratio >= 1 ? Style::good : Style::bad}
                  : entry.race.complete ? TextCell{""}
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
            chosen->geometric_mean, chosen->worst, 100 * chosen->kept));
    }
  const validate::WrongHits wrong = validate::embree_wrong_hits(bench.entries);
  const bool agree = validate::do_own_hits_agree(bench.entries);
  text += fmt::format(
      "\nhits: ours {}; {}\n", styled(screen, agree ? Style::good : Style::bad, agree ? "all agree" : "DO NOT AGREE"),
      has_embree ? fmt::format("Embree, in single precision, is wrong about {} of {}", wrong.wrong, wrong.hits)
                 : "this detp was built without Embree");
  return text;
}

std::string number_text(double number, bool at_least) { return fmt::format("{}{:.3g}", at_least ? ">= " : "", number); }

std::vector<TextCell> figure_cells(const Figures& figures) {
  if (figures.rows == 0) return {{}, {}, {}};
  const bool at_least = figures.at_least > 0;
  return {{number_text(figures.geometric_mean, at_least), Style::strong},
          {number_text(figures.p95, at_least)},
          {number_text(figures.worst, at_least)}};
}

std::vector<TextCell> regret_cells(const std::string& what, const std::string& candidate,
                                   const RegretFigures& figures) {
  std::vector<TextCell> cells{{what}, {candidate}};
  for (const Figures& half : {figures.fitted, figures.held_out})
    for (TextCell& cell : figure_cells(half)) cells.push_back(std::move(cell));
  return cells;
}

std::string regret_table(const RegretSummary& summary, const Screen& screen) {
  const std::string fitted = "fitted scenes";
  const std::string held_out = "held-out scenes";
  TextTable table({{.head = "regret of", .align = Align::left},
                   {.head = "candidate", .align = Align::left, .spare = 1},
                   {.head = "mean", .group = fitted},
                   {.head = "p95", .group = fitted},
                   {.head = "worst", .group = fitted},
                   {.head = "mean", .group = held_out},
                   {.head = "p95", .group = held_out},
                   {.head = "worst", .group = held_out}});
  for (const TierSummary& tier : summary.tiers) table.add(regret_cells(tier.tier, "", tier.regret));
  for (std::size_t i = 0; i < summary.baselines.size(); ++i) {
    const auto candidate = validate::candidate_of(i, summary.baselines[i]);
    table.add(regret_cells(std::string(validate::baselines()[i].text), candidate ? title(*candidate) : "",
                           summary.baselines[i].regret));
  }
  return table.text(screen);
}

std::string regret_summary_text(const RegretSummary& summary, const Screen& screen) {
  std::string text = fmt::format("{}{}, {} workload{}\n", summary.threads == 1 ? "" : "At most ",
                                 threads_text(summary.threads), summary.rows, summary.rows == 1 ? "" : "s");
  if (summary.rows == 0) return text;
  const auto add = [&](const std::string& line) { text += wrapped(line, screen.text_width(), 10); };
  text += regret_table(summary, screen);
  add(
      fmt::format("noise     the best, timed twice as if it were two candidates: factor {:.3g} in the geometric mean, "
                  "p95 {:.3g}, worst {:.3g}",
                  summary.noise.geometric_mean, summary.noise.p95, summary.noise.worst));
  for (const TierSummary& tier : summary.tiers) {
    if (tier.price.rows > 0)
      add(
          fmt::format("price     {}: choosing and run take {} times the best, in the geometric mean of {} workloads "
                      "whose best takes over {:g} ms",
                      tier.tier, number_text(tier.price.geometric_mean, tier.price.at_least > 0), tier.price.rows,
                      1e3 * validate::shortest_priced_run));
    if (tier.prediction.rows > 0)
      add(fmt::format("predicted {}: the seconds of the choices are off by {:.0f} % in the median, p95 {:.0f} %",
                      tier.tier, 100 * tier.prediction.median_error, 100 * tier.prediction.p95_error));
  }
  return text + "\n";
}

std::string worst_text(const validate::RegretResult& regret, const Screen& screen) {
  const auto worst = validate::worst_choices(regret.rows, validate::most_worst_choices);
  if (worst.empty()) return "";
  std::string text = fmt::format("The {} largest regrets\n", worst.size());
  for (const validate::TierRow& one : worst) {
    const RegretRow& row = *one.row;
    const ChoiceRow& choice = *one.choice;
    const auto run = [&](const Candidate& candidate, int threads) {
      return row.threads == 1 ? title(candidate) : fmt::format("{}, {}", title(candidate), threads_text(threads));
    };
    text +=
        wrapped(fmt::format("{:<10}{}, {}{}: {} takes {}; the best is {}. Reason: {}",
                            number_text(choice.regret.value, choice.regret.at_least), escaped(title_of(row.workload)),
                            row.threads == 1 ? "" : "at most ", threads_text(row.threads), choice.tier,
                            run(choice.choice.prediction.candidate, choice.choice.prediction.threads),
                            run(row.best, row.best_threads), choice.reason),
                screen.text_width(), 10);
  }
  return text + "\n";
}

std::string left_out_text(const validate::BenchSet& set, const validate::SetProgress& progress, const Screen& screen) {
  std::string text;
  const auto add = [&](const std::string& line) { text += wrapped(line, screen.text_width(), 10); };
  for (const std::string& why : set.missing) add(fmt::format("left out  {}", why));
  for (const validate::SkippedWorkload& skip : progress.skipped)
    add(fmt::format("skipped   {}: {}", title_of(skip.workload), skip.why));
  return text;
}

}  // namespace

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

Result report(const validate::RegretAnswer& answer, const Screen& screen) {
  Result result;
  result.json = json_of(validate::regret_fields(), answer);
  for (const RegretSummary& summary : answer.summaries) result.text += regret_summary_text(summary, screen);
  result.text += worst_text(answer.result, screen);
  result.text +=
      legend(screen,
             "regret: seconds of the candidate over seconds of the best of all that were tried. mean: geometric mean. "
             "p95: 95 % of the workloads have at most this. >=: at least; some runs were abandoned and count with "
             "the time after which they were. radius: of the discs, % of the scene's longest side.");
  result.text += left_out_text(answer.set, answer.result, screen);
  result.text += wrapped("costs     " + answer.costs.origin, screen.text_width(), 10);
  Table table(columns_of(validate::tier_fields()));
  for (const validate::TierRow& row : tier_rows(answer)) table.add(cells_of(validate::tier_fields(), row));
  result.csv = table.csv();
  if (answer.result.stopped) result.stopped = {answer.result.done, answer.result.workloads, "workloads"};
  return result;
}

}  // namespace detp::cli
