#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "choose_report.hpp"
#include "detp/validate/cli/text/table.hpp"

/// The parts of the answer that its text, JSON and CSV share: candidates, what was measured, rivals, tips, tables.
namespace detp::cli {

struct ChooseRow {
  Candidate candidate;
  const Prediction* predicted = nullptr;
  const validate::Analysed* run = nullptr;
  bool chosen = false;
};

/// Rows in the order of the ranking. After an analysis, the other candidates that were tried follow. The rows refer to
/// the answer.
[[nodiscard]] std::vector<ChooseRow> rows_of(const ChooseAnswer& answer);

/// The number of threads of the row's prediction and runs.
[[nodiscard]] int threads_of(const ChooseRow& row);

/// The standard error of the row's time, seconds; nothing if a pilot did not predict it.
[[nodiscard]] std::optional<double> error_of(const ChooseAnswer& answer, const ChooseRow& row);

/// Whether the row's predicted time cannot be told apart from that of the predicted choice. Requires a prediction.
[[nodiscard]] bool could_win(const ChooseAnswer& answer, const ChooseRow& row);

/// What takes most of the time: "ray-disc tests".
[[nodiscard]] std::string largest_part(const CostBreakdown& time);

/// The columns that follow the predictions in the table of candidates: counted, measured, predicted / measured.
[[nodiscard]] std::vector<TextColumn> measured_table_columns();
[[nodiscard]] std::vector<TextCell> measured_cells(const validate::Analysed& run);

/// Why a candidate that was not timed was not: "given up after 0.02 s".
[[nodiscard]] std::string why_not_measured(const validate::Analysis& analysis, const validate::Analysed& run);

/// Appends the results of a candidate's run: `counted`, `measured_seconds`, …, or the reason why it was not measured.
void add_measured(Json& json, const validate::Analysis& analysis, const validate::Analysed& run);

/// PredictionError as JSON members, with the names that they have under `missed` in the output. An empty object if the
/// candidate was not predicted, not counted or not timed.
[[nodiscard]] Json missed_ratios(const validate::Analysed& run, const CostTable& costs);

/// The lines "choice", "regret" and "predicted": the candidate with the shortest measured time, whether it was the predicted
/// choice, and how well its seconds were predicted. After a stop, also how many candidates were tried.
[[nodiscard]] std::string measured_lines(const ChooseAnswer& answer, const Screen& screen);

/// The line "gain": what testing all pairs would take, as predicted. Empty if nothing was measured.
[[nodiscard]] std::string gain_line(const ChooseAnswer& answer);

/// The lines "missed": the errors of the predictions of the predicted choice and of the fastest candidate.
[[nodiscard]] std::string missed_lines(const ChooseAnswer& answer, const Screen& screen);

[[nodiscard]] std::string choice_text(const std::string& what, const Screen& screen);

/// Appends `predicted_choice`, `best_measured`, `tried`, `regret`, `missed` and `stopped`.
void add_analysis(Json& json, const ChooseAnswer& answer);

/// Appends `tips`, `tips_range` and `tips_seconds`.
void add_tips(Json& json, const ChooseAnswer& answer);

/// The line "tips": changes of one input that change the choice, and where no other technique wins.
[[nodiscard]] std::string tips_line(const ChooseAnswer& answer);

/// The line "tips", shorter: the techniques that are or may be faster elsewhere, at most `most` of them; if there are none, where no
/// other technique wins.
[[nodiscard]] std::string short_tips_line(const ChooseAnswer& answer, std::size_t most);

/// The line "rival": the technique next to the choice, and how much slower it is or why it is ruled out. Then the
/// techniques that were not examined. After a measurement, the fastest candidate of another technique.
[[nodiscard]] std::string rival_line(const ChooseAnswer& answer);

/// The table of candidates, after an empty line.
[[nodiscard]] std::string candidate_table(const ChooseAnswer& answer, const Screen& screen);

/// After an analysis: the fastest measured candidate of each technique and the predicted choice, after an empty line. Then
/// the techniques that were not timed.
[[nodiscard]] std::string measured_table(const ChooseAnswer& answer, const Screen& screen);

/// The notes below the table: what it extrapolates, and what its columns mean.
[[nodiscard]] std::string candidate_notes(const ChooseAnswer& answer, const Screen& screen);

}  // namespace detp::cli
