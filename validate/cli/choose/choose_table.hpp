#pragma once

#include <string>

#include "choose_report.hpp"

namespace detp::cli {

/// The table of candidates, after an empty line.
[[nodiscard]] std::string candidate_table(const ChooseAnswer& answer, const Screen& screen);

/// After an analysis: the fastest measured candidate of each technique and the predicted choice, after an empty line. Then
/// the techniques that were not timed.
[[nodiscard]] std::string measured_table(const ChooseAnswer& answer, const Screen& screen);

/// The notes below the table: what it extrapolates, and what its columns mean.
[[nodiscard]] std::string candidate_notes(const ChooseAnswer& answer, const Screen& screen);

}  // namespace detp::cli
