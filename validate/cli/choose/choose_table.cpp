#include "choose_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "detp/model/closed_form/reasons.hpp"
#include "detp/validate/cli/report/prediction_report.hpp"
#include "detp/validate/cli/text/table.hpp"
#include "detp/validate/cli/text/words.hpp"

namespace detp::cli {
namespace {

/// The columns of what was measured: counted, measured, predicted / measured.
std::vector<TextColumn> measured_table_columns() {
  return {{.head = "tests", .spare = 3, .group = "counted"},
          {.head = "seconds", .align = Align::left, .group = "measured"},
          {.head = "tests", .spare = 2, .group = "predicted / measured"},
          {.head = "seconds", .align = Align::left, .group = "predicted / measured"}};
}

std::vector<TextCell> measured_cells(const ChooseRow& row) {
  const validate::Analysed& run = *row.run;
  std::vector<TextCell> cells(4);
  if (!run.counted) return cells;
  const auto counted = static_cast<double>(tests(*run.counted));
  cells[0].text = fmt::format("{:.3g}", counted);
  if (row.predicted != nullptr && counted > 0)
    cells[2].text = fmt::format("{:.2f}", tests(row.predicted->counts) / counted);
  if (!run.seconds) return cells;
  cells[1].text = fmt::format("{:.3g}", *run.seconds);
  if (run.spread > 0) cells[1].text += fmt::format(" ± {:.1g}", run.spread);
  if (!row.missed) return cells;
  const double ratio = row.missed->seconds;
  const bool far_off = ratio > 2 || ratio < 0.5;
  cells[3] = {fmt::format("{:.2f}{}", ratio, far_off ? " !" : ""), far_off ? Style::doubtful : Style::plain};
  return cells;
}

/// The row's predicted time compared with the choice's: after a pilot whether they can be told apart (nothing for the choice); else the ratio,
/// and the largest part of the row's time.
std::vector<TextCell> compared_cells(const ChooseAnswer& answer, const ChooseRow& row) {
  const double ratio = row.predicted->seconds() / answer.choice.best().seconds();
  if (!answer.by_sample())
    return {{fmt::format("{:.3g}", ratio)}, {std::string(validate::largest_part(row.predicted->time))}};
  if (row.chosen()) return {{}};
  return {{as_long(ratio) + (row.could_win ? ", too close to tell" : "")}};
}

/// Whether closed forms other than those of box trees and brute force are never chosen if they are extrapolated.
bool is_real(const ChooseAnswer& answer) { return answer.by_sample() || !model::is_counted_scene(answer.workload); }

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
    const Style style = row.chosen() ? Style::good : Style::plain;
    std::vector<TextCell> cells{{std::string(name(row.candidate.technique)), style},
                                {describe(row.candidate), style},
                                {fmt::format("{}", row.threads)}};
    if (row.predicted != nullptr) {
      const std::string_view mark =
          extrapolation_mark(row.candidate.technique, row.predicted->extrapolated, is_real(answer));
      cells.push_back({fmt::format("{:.3g}", tests(row.predicted->counts))});
      const double error = row.error();
      cells.push_back({fmt::format("{:.3g}{}{}", row.predicted->seconds(), mark,
                                   error > 0 ? fmt::format(" ± {:.1g}", error) : "")});
    }
    cells.resize(5);
    for (const TextCell& cell : answer.analysis ? measured_cells(row) : compared_cells(answer, row))
      cells.push_back(cell);
    cells.push_back({row.chosen() ? "<- choice" : row.not_run, row.chosen() ? Style::good : Style::faint});
    table.add(std::move(cells));
  }
  return "\n" + table.text(screen);
}

std::string measured_table(const ChooseAnswer& answer, const Screen& screen) {
  const std::vector<ChooseRow> rows = rows_of(answer);
  std::vector<const ChooseRow*> shown;  // of each technique the fastest; the first if none was timed
  for (const ChooseRow& row : rows) {
    const auto same = std::ranges::find(shown, row.candidate.technique,
                                        [](const ChooseRow* one) { return one->candidate.technique; });
    if (same == shown.end())
      shown.push_back(&row);
    else if (row.run->seconds && (!(*same)->run->seconds || *row.run->seconds < *(*same)->run->seconds))
      *same = &row;
  }
  std::vector<std::pair<std::string, std::vector<std::string_view>>> untimed;  // by the reason
  for (const ChooseRow* row : shown) {
    if (row->run->seconds) continue;
    auto same = std::ranges::find(untimed, row->not_run, [](const auto& one) { return one.first; });
    if (same == untimed.end()) same = untimed.insert(untimed.end(), {row->not_run, {}});
    same->second.push_back(name(row->candidate.technique));
  }
  std::erase_if(shown, [](const ChooseRow* row) { return !row->run->seconds; });
  if (shown.empty()) return "";
  if (rows.front().run->seconds && std::ranges::find(shown, &rows.front()) == shown.end())
    shown.push_back(&rows.front());
  std::ranges::stable_sort(shown, {}, [](const ChooseRow* row) { return *row->run->seconds; });
  TextTable table({{.head = "technique", .align = Align::left},
                   {.head = "parameters", .align = Align::left},
                   {.head = "predicted s", .align = Align::left},
                   {.head = "measured s", .align = Align::left},
                   {.head = "tests", .spare = 2, .group = "predicted / measured"},
                   {.head = "seconds", .align = Align::left, .group = "predicted / measured"},
                   {.head = "", .align = Align::left}});
  for (const ChooseRow* row : shown) {
    const Style style = row->chosen() ? Style::good : Style::plain;
    const std::vector<TextCell> measured = measured_cells(*row);
    const bool predicted = row == &rows.front();
    table.add({{std::string(name(row->candidate.technique)), style},
               {describe(row->candidate), style},
               {row->predicted == nullptr ? "none" : fmt::format("{:.3g}", row->predicted->time.again())},
               measured[1],
               measured[2],
               measured[3],
               {row->chosen() ? "<- fastest"
                : predicted   ? "<- predicted choice"
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
