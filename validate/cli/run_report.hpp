#pragma once

#include <string>

#include "answer_rows.hpp"
#include "timed_run.hpp"

namespace detp::cli {

/// The results and times of one run.
struct RunAnswer {
  Candidate candidate = {};
  Engine engine = Engine::simd;
  TimedRun run = {};
  Timing timing = {};
  int repeat = 0;            ///< timed runs requested
  bool random_rays = false;  ///< true for rays of a random field: the first ones are representative of all
};

/// Hits, counts and seconds; and the closed forms' predictions for the same workload, if there are any. A stopped run
/// has no `hits` and no irradiance, but `hits_so_far` (of the finished rays or discs) and, if these are random rays,
/// `hits_estimate` for all rays.
[[nodiscard]] AnswerRow run_row(Json inputs, const validate::Job& job, const RunAnswer& answer);

[[nodiscard]] Columns run_columns();
[[nodiscard]] TextColumns run_text_columns(const Screen& screen);

[[nodiscard]] std::string to_text(const validate::Job& job, const RunAnswer& answer, const Screen& screen);

}  // namespace detp::cli
