#pragma once

#include "choose_report.hpp"
#include "detp/validate/cli/text/text_table.hpp"

namespace detp::cli {

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

/// The line "gain": what the obvious ways would take, as predicted. Empty if nothing was measured.
[[nodiscard]] std::string gain_line(const ChooseAnswer& answer);

/// The lines "missed": the errors of the predictions of the predicted choice and of the fastest candidate.
[[nodiscard]] std::string missed_lines(const ChooseAnswer& answer, const Screen& screen);

[[nodiscard]] std::string choice_text(const std::string& what, const Screen& screen);

/// Appends `predicted_choice`, `best_measured`, `tried`, `regret`, `missed` and `stopped`.
void add_analysis(Json& json, const ChooseAnswer& answer);

}  // namespace detp::cli
