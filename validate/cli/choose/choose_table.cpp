#include "choose_parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "detp/model/rank/extrapolation.hpp"
#include "detp/validate/cli/report/prediction_report.hpp"
#include "detp/validate/cli/text/table.hpp"
#include "detp/validate/cli/text/words.hpp"

namespace detp::cli {
namespace {

/// Two cells: the row's predicted time divided by that of the first candidate, and the name of the largest part of the
/// row's predicted time. For instance "3.5" and "ray-disc tests".
std::vector<TextCell> comparison_cells(const ChooseAnswer& answer, const ChooseRow& row) {
  const CostBreakdown& time = row.predicted->time;
  return {{fmt::format("{:.3g}", time.total() / answer.choice.best().time.total())}, {largest_part(time)}};
}

/// The row's predicted time compared with the choice's, and whether they can be told apart; nothing for the choice.
std::vector<TextCell> pilot_cells(const ChooseAnswer& answer, const ChooseRow& row) {
  if (row.chosen) return {{}};
  const double ratio = row.predicted->time.total() / answer.choice.best().time.total();
  return {{as_long(ratio) + (could_win(answer, row) ? ", too close to tell" : "")}};
}

/// Whether closed forms other than those of box trees and brute force are never chosen if they are extrapolated.
bool is_real(const ChooseAnswer& answer) { return answer.by_sample() || !model::is_counted_scene(answer.workload); }

std::string verdict(const ChooseAnswer& answer, const ChooseRow& row) {
  if (row.chosen) return "<- choice";
  if (row.run == nullptr || row.run->seconds) return "";
  Json json;
  add_measured(json, *answer.analysis, *row.run);
  return json["not_run"];
}

}  // namespace

std::string candidate_table(const ChooseAnswer& answer, const Screen& screen) {
  std::vector<TextColumn> columns{{.head = "technique", .align = Align::left},
                                  {.head = "parameters", .align = Align::left},
                                  {.head = "threads", .spare = 2},
                                  {.head = "tests", .spare = 1, .group = "predicted"},
                                  {.head = "seconds", .align = Align::left, .group = "predicted"}};
  if (answer.analysis)
    for (const TextColumn& column : measured_table_columns()) columns.push_back(column);
  else if (answer.by_sample())
    columns.push_back({.head = "compared with the choice", .align = Align::left});
  else
    columns.insert(columns.end(),
                   {{.head = "times the first", .spare = 3}, {.head = "mostly", .align = Align::left, .spare = 2}});
  columns.push_back({.head = "", .align = Align::left});
  TextTable table(std::move(columns));
  for (const ChooseRow& row : rows_of(answer)) {
    const Style style = row.chosen ? Style::good : Style::plain;
    std::vector<TextCell> cells{{std::string(name(row.candidate.technique)), style},
                                {describe(row.candidate), style},
                                {fmt::format("{}", threads_of(row))}};
    if (row.predicted != nullptr) {
      const std::string_view mark =
          extrapolation_mark(row.candidate.technique, row.predicted->extrapolated, is_real(answer));
      cells.push_back({fmt::format("{:.3g}", tests(row.predicted->counts))});
      const double error = error_of(answer, row).value_or(0);
      cells.push_back({fmt::format("{:.3g}{}{}", row.predicted->time.total(), mark,
                                   error > 0 ? fmt::format(" ± {:.1g}", error) : "")});
    }
    cells.resize(5);
    for (const TextCell& cell : answer.analysis      ? measured_cells(*row.run)
                                : answer.by_sample() ? pilot_cells(answer, row)
                                                     : comparison_cells(answer, row))
      cells.push_back(cell);
    cells.push_back({verdict(answer, row), row.chosen ? Style::good : Style::faint});
    table.add(std::move(cells));
  }
  return "\n" + table.text(screen);
}

std::string measured_table(const ChooseAnswer& answer, const Screen& screen) {
  const validate::Analysis& analysis = *answer.analysis;
  const std::vector<ChooseRow> rows = rows_of(answer);
  std::vector<const ChooseRow*> fastest;  // of each technique, and the predicted choice
  std::vector<std::pair<std::string, std::vector<std::string_view>>> untimed;  // by the reason
  for (const ChooseRow& row : rows) {
    if (!row.run->seconds) continue;
    const auto same = std::ranges::find(fastest, row.candidate.technique,
                                        [](const ChooseRow* one) { return one->candidate.technique; });
    if (same == fastest.end())
      fastest.push_back(&row);
    else if (*row.run->seconds < *(*same)->run->seconds)
      *same = &row;
  }
  if (fastest.empty()) return "";
  std::vector<Technique> told;
  for (const ChooseRow& row : rows) {
    const Technique technique = row.candidate.technique;
    const bool timed = std::ranges::any_of(
        rows, [&](const ChooseRow& one) { return one.candidate.technique == technique && one.run->seconds; });
    if (timed || std::ranges::find(told, technique) != told.end()) continue;
    told.push_back(technique);
    const std::string reason = why_not_measured(analysis, *row.run);
    auto same = std::ranges::find(untimed, reason, [](const auto& one) { return one.first; });
    if (same == untimed.end()) same = untimed.insert(untimed.end(), {reason, {}});
    same->second.push_back(name(technique));
  }
  if (rows.front().run->seconds && std::ranges::find(fastest, &rows.front()) == fastest.end())
    fastest.push_back(&rows.front());
  std::ranges::stable_sort(fastest,
                           [](const ChooseRow* a, const ChooseRow* b) { return *a->run->seconds < *b->run->seconds; });
  TextTable table({{.head = "technique", .align = Align::left},
                   {.head = "parameters", .align = Align::left},
                   {.head = "predicted s", .align = Align::left},
                   {.head = "measured s", .align = Align::left},
                   {.head = "tests", .spare = 2, .group = "predicted / measured"},
                   {.head = "seconds", .align = Align::left, .group = "predicted / measured"},
                   {.head = "", .align = Align::left}});
  for (const ChooseRow* row : fastest) {
    const Style style = row->chosen ? Style::good : Style::plain;
    const std::vector<TextCell> measured = measured_cells(*row->run);
    const bool predicted = row == &rows.front();
    table.add({{std::string(name(row->candidate.technique)), style},
               {describe(row->candidate), style},
               {row->predicted == nullptr ? "none" : fmt::format("{:.3g}", row->predicted->time.again())},
               measured[1],
               measured[2],
               measured[3],
               {row->chosen ? "<- fastest"
                : predicted ? "<- predicted choice"
                            : "",
                style}});
  }
  std::string text = "\n" + table.text(screen);
  for (const auto& [reason, techniques] : untimed)
    text += wrapped(fmt::format("not timed: {} ({})", fmt::join(techniques, ", "), reason), screen.text_width(), 2);
  return text;
}

std::string candidate_notes(const ChooseAnswer& answer, const Screen& screen) {
  std::vector<std::pair<Technique, std::vector<std::string>>> predictions;
  for (const ChooseRow& row : rows_of(answer))
    if (row.predicted != nullptr) predictions.emplace_back(row.candidate.technique, row.predicted->extrapolated);
  std::string text =
      "tests: of a ray against a sphere, a box or a disc. X: distance between neighbouring samples over d. D: "
      "dimension of the samples, 2 on surfaces, 3 in a volume. Q, k: ratio of the radii of nested spheres, their "
      "number. r0: "
      "radius of the sphere around all discs.";
  if (answer.analysis)
    text +=
        " ± of measured seconds: half the range of the timed runs; none where there was one run. ! after a ratio: "
        "predicted seconds off by more than a factor of two.";
  if (answer.by_sample())
    text +=
        " ± of predicted seconds: standard error, of the pilot's counts and of unit costs. Too close to "
        "tell: less than 15 % longer than the choice, which is about the error of calibrated unit costs.";
  const std::string extrapolated = extrapolated_note(predictions, is_real(answer));
  return (extrapolated.empty() ? "" : wrapped(extrapolated, screen.text_width(), 2)) + legend(screen, text);
}

}  // namespace detp::cli
