#pragma once

#include <optional>
#include <string>

#include "detp/validate/accuracy/error_split.hpp"
#include "detp/validate/choice/choice.hpp"
#include "detp/validate/cli/report/answer_rows.hpp"
#include "detp/validate/cli/report/prediction_report.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/stopping/run_until.hpp"
#include "detp/validate/whole/whole.hpp"
#include "timed_run.hpp"

/// The answer of `detp run`: its record, what it was predicted to take, and its whole wait.
namespace detp::cli {

/// Of an estimator at the radius of a run.
struct BiasEstimate {
  validate::Estimate squared;    ///< relative to B²
  validate::Estimate mean = {};  ///< signed, relative to the mean irradiance; not known by two radii
  std::size_t runs = 8;
  std::string by = {};  ///< what the estimator was compared with

  [[nodiscard]] validate::RootInterval interval() const { return root_of(squared, runs); }

  double seconds = 0;  ///< that finding it took
  double radius = 0;   ///< the largest of the radii tried whose bias is below the target; 0: none
};

/// How a run until an error ended.
struct UntilAnswer {
  double target = 0;
  bool total = false;  ///< the target is of noise and bias together
  double confidence = 0;
  validate::UntilResult result = {};
  std::optional<BiasEstimate> bias = {};
  double seconds = 0;           ///< with choosing, the bias's pilot, tracing and building
  sim::LightLedger light = {};  ///< of all photons that were traced
  double mirror_share = 0;      ///< of the area, that has no part in the error

  /// Noise and bias together; without a known bias the noise.
  [[nodiscard]] validate::NoiseInterval error() const {
    return with_bias(result.noise, bias ? bias->squared : validate::Estimate{});
  }
};

struct RunAnswer {
  Candidate candidate = {};  ///< of an estimator that uses none, without meaning
  sim::Estimator estimator = sim::Estimator::disc;
  std::uint64_t paths = 0;                      ///< of gather
  int threads = 1;                              ///< on which it ran
  CostTable costs = {};                         ///< with which the candidate was chosen and its time predicted
  std::optional<validate::Choice> choice = {};  ///< by which the candidate was chosen, with its rays in memory
  Engine engine = Engine::simd;
  std::optional<Form> form = {};  ///< requested: of the formulas that predict the counts
  JobRun run = {};
  Timing timing = {};
  int repeat = 0;               ///< timed runs requested
  bool standard_error = false;  ///< requested
  std::optional<UntilAnswer> until = {};
  std::optional<RaysTaken> taken = {};  ///< of a stream of photon paths: those that were searched
  validate::WholeInputs whole = {};     ///< of the command, if the rays are known before
  bool random_rays = false;  ///< true for rays of a random field: the first rays are representative of all rays
};

/// What a run without hits met, and the likely reason; the light that is missing.
[[nodiscard]] std::vector<std::string> answer_warnings(const validate::Job& job, const RunAnswer& answer);

/// The estimator needs no rays.
[[nodiscard]] inline bool gathers(const RunAnswer& answer) { return sim::record_of(answer.estimator).needs_scene; }

/// Hits, counts and seconds, and the predictions of the candidate's closed form if it has one. A stopped run has no
/// `hits` and no irradiance. It has `hits_so_far`, the hits of the finished rays or discs, and if random rays were
/// finished, `hits_estimate` for all rays.
/// `alone`: the command has no other row, so that its whole time and memory are those of this one.
[[nodiscard]] AnswerRow run_row(Json inputs, const validate::Job& job, const RunAnswer& answer, bool alone);

[[nodiscard]] Columns run_columns();
[[nodiscard]] TextColumns run_text_columns(const Screen& screen);

/// `verbose`: also the effects, and the table of counts. Without it, nothing is measured.
[[nodiscard]] std::string to_text(const validate::Job& job, const RunAnswer& answer, const Screen& screen,
                                  bool verbose);

/// The counts of the choice come from a pilot. Of brute force it knows all but the hits.
[[nodiscard]] bool is_predicted(const RunAnswer& answer);

/// The paper has formulas for the technique's counts.
[[nodiscard]] bool is_published(Technique technique);

/// Those of the paper's formulas if they are requested. Else the counts that a pilot predicted, or else the closed form on this workload: the job's, or what is known of it without measuring. Nothing if the
/// candidate has none, and of other estimators and runs until an error.
[[nodiscard]] std::optional<Counts<double>> prediction(const Workload& workload, const RunAnswer& answer);

/// The same, whatever form is requested.
[[nodiscard]] std::optional<Counts<double>> best_prediction(const Workload& workload, const RunAnswer& answer);

/// Of the whole command: of pairs from best_prediction, of estimators that look at photons by AccuracyCosts and the hits expected of closed forms.
/// Nothing for backward paths, whose rays are known only by a pilot (`accuracy`), and for runs until an error.
[[nodiscard]] std::optional<Whole> predicted_whole(const validate::Job& job, const RunAnswer& answer,
                                                   const Workload& workload);

/// Until now.
[[nodiscard]] Whole measured_whole(const validate::Job& job, const RunAnswer& answer);

}  // namespace detp::cli
