#pragma once

#include <string>

#include "answer_rows.hpp"
#include "timed_run.hpp"

namespace detp::cli {

/// What one run found, and how long it took.
struct RunAnswer {
  Candidate candidate = {};
  Engine engine = Engine::simd;
  TimedRun run = {};
  Timing timing = {};
  int repeat = 0;            ///< timed runs asked for
  bool random_rays = false;  ///< of a field: the first ones say what all are like
};

/// Hits, counts and seconds; beside them what the closed forms predict of the same workload, where there are any. A
/// stopped run has no `hits` and no irradiance but `hits_so_far` (of the rays or discs done) and, where those are
/// random rays, `hits_estimate` for all rays.
[[nodiscard]] AnswerRow run_row(Json inputs, const validate::Job& job, const RunAnswer& answer);

[[nodiscard]] Columns run_columns();
[[nodiscard]] TextColumns run_text_columns();

[[nodiscard]] std::string to_text(const validate::Job& job, const RunAnswer& answer);

}  // namespace detp::cli
