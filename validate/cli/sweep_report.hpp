#pragma once

#include "command.hpp"
#include "detp/validate/sweep/sweep.hpp"

namespace detp::cli {

/// Adds a sweep to what a command found: a summary for each quantity ("sweep" in JSON, a table in the text), and every
/// comparison as CSV.
void report_sweep(const validate::SweepResult& sweep, Result& result);

}  // namespace detp::cli
