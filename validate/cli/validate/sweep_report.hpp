#pragma once

#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/cli/text/table.hpp"
#include "detp/validate/sweep/sweep.hpp"

namespace detp::cli {

/// The columns of a sweep's comparison that a claim does not have.
[[nodiscard]] Columns sweep_columns();

/// Adds a sweep to a command's result: a summary for each quantity ("sweep" in JSON, a table in the text), and every
/// comparison as a row of the table.
void report_sweep(const validate::SweepResult& sweep, const Screen& screen, Table& table, Result& result);

/// Writes the comparisons as CSV: one row for each compared count, with the predictions of both forms. Counts that are
/// the same in every set and equal their prediction are left out. Predictions and observations have five digits,
/// standard errors two. Throws sim::FileError.
void write_sweep_rows(const std::string& path, const std::vector<validate::Deviation>& deviations,
                      const std::stop_token& stop = {});

}  // namespace detp::cli
