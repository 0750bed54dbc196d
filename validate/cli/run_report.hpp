#pragma once

#include <string>

#include "answer_rows.hpp"
#include "timed_run.hpp"

namespace detp::cli {

/// What one run found, and how long it took.
struct RunAnswer {
  Candidate candidate = {};
  TimedRun run = {};
  Timing timing = {};
  int repeat = 0;  ///< timed runs asked for
};

/// Hits, counts and seconds; beside them what the closed forms predict of the same workload, where there are any.
[[nodiscard]] AnswerRow run_row(Json inputs, const validate::Job& job, const RunAnswer& answer);

[[nodiscard]] Columns run_columns();
[[nodiscard]] TextColumns run_text_columns();

[[nodiscard]] std::string to_text(const validate::Job& job, const RunAnswer& answer);

/// disc,hits,irradiance in input order.
[[nodiscard]] std::string per_disc_csv(const sim::Outcome& outcome);

}  // namespace detp::cli
