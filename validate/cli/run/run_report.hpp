#pragma once

#include <string>

#include "detp/validate/choice/choice.hpp"
#include "detp/validate/cli/report/answer_rows.hpp"
#include "timed_run.hpp"

namespace detp::cli {

struct RunAnswer {
  Candidate candidate = {};  ///< of an estimator that uses none, without meaning
  sim::Estimator estimator = sim::Estimator::disc;
  int threads = 1;                              ///< on which it ran
  CostTable costs = {};                         ///< with which the candidate was chosen and its time predicted
  std::optional<validate::Choice> choice = {};  ///< by which the candidate was chosen, with its rays in memory
  Engine engine = Engine::simd;
  TimedRun run = {};
  Timing timing = {};
  int repeat = 0;               ///< timed runs requested
  bool standard_error = false;  ///< requested
  bool random_rays = false;     ///< true for rays of a random field: the first rays are representative of all rays
};

/// Whether a technique found the pairs, or the nearest photons.
[[nodiscard]] inline bool has_technique(const RunAnswer& answer) {
  return sim::record_of(answer.estimator).finds_pairs || answer.estimator == sim::Estimator::nearest;
}

/// Hits, counts and seconds, and the predictions of the candidate's closed form if it has one. A stopped run has no
/// `hits` and no irradiance. It has `hits_so_far`, the hits of the finished rays or discs, and if random rays were
/// finished, `hits_estimate` for all rays.
[[nodiscard]] AnswerRow run_row(Json inputs, const validate::Job& job, const RunAnswer& answer);

[[nodiscard]] Columns run_columns();
[[nodiscard]] TextColumns run_text_columns(const Screen& screen);

[[nodiscard]] std::string to_text(const validate::Job& job, const RunAnswer& answer, const Screen& screen);

}  // namespace detp::cli
