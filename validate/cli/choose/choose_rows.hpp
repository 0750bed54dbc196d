#pragma once

#include <optional>
#include <string>
#include <vector>

#include "choose_report.hpp"

/// The candidates of a choice as the text, JSON and CSV show them.
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

/// What a pilot predicted of the row, with its errors; null if a pilot did not predict it.
[[nodiscard]] const Prediction* piloted(const ChooseAnswer& answer, const ChooseRow& row);

/// The standard error of the row's time, seconds; nothing if a pilot did not predict it.
[[nodiscard]] std::optional<double> error_of(const ChooseAnswer& answer, const ChooseRow& row);

/// Whether the row's predicted time cannot be told apart from that of the predicted choice. Requires a prediction.
[[nodiscard]] bool could_win(const ChooseAnswer& answer, const ChooseRow& row);

/// What takes most of the time: "ray-disc tests".
[[nodiscard]] std::string largest_part(const CostBreakdown& time);

}  // namespace detp::cli
