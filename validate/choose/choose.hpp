#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "detp/model/ranks/ranks.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/effects/observe.hpp"
#include "detp/validate/base/fields.hpp"
#include "detp/validate/choice/analysis.hpp"
#include "detp/validate/choice/choice.hpp"
#include "detp/validate/choice/tips.hpp"
#include "detp/validate/job/job.hpp"
#include "detp/validate/whole/whole.hpp"

/// What `detp choose` does, in one call: the fastest technique for a scene, files or numbers, and why.
namespace detp::validate {

/// Processes that would share the run, each with the threads of the request.
struct RanksRequest {
  double ranks = 1;
  double bytes_per_second = model::Network{}.bytes_per_second;
};

struct ChooseRequest {
  JobRequest job = {};
  CostTable costs = {};           ///< seconds; their engine runs the candidates
  std::string costs_origin = {};  ///< "of each operation: built in, ..."
  /// default: a pilot where there are rays, and closed forms for numbers; measure: the fastest of the analysis is the choice
  std::optional<Rigor> rigor = {};
  bool analyze = false;                       ///< run the candidates; always with Rigor::measure
  std::vector<Technique> disabled = {};       ///< may not be chosen
  int threads = 1;                            ///< most threads; not 0
  std::optional<RanksRequest> ranks = {};     ///< also predict what these take
  std::function<void(const Job&)> made = {};  ///< called when rays and discs are known, before all long work

  [[nodiscard]] bool analyzes() const { return analyze || rigor == Rigor::measure; }
};

/// What processes that share a run take.
struct RanksAnswer {
  double ranks = 1;
  model::Network network;
  bool by_rays = true;  ///< what is chosen
  bool fits = true;     ///< in a rank's memory
  double memory_limit = 0;
  model::SharedTime rays;
  model::SharedTime discs;
  double alone = 0;  ///< seconds of one process
  /// of the chosen time, as far as it is known: the prediction's of the search, the standard error of making rays
  double error = 0;

  [[nodiscard]] const model::SharedTime& best() const { return by_rays ? rays : discs; }
};

struct ChooseAnswer {
  std::optional<Job> job = {};  ///< rays and discs; nothing if numbers alone are known
  Workload workload = {};
  std::vector<sim::EffectReport> effects = {};
  Choice choice = {};       ///< predicted
  Prediction paper = {};    ///< the paper's rule of thumb
  double brute_force = 0;   ///< predicted seconds of testing all pairs, in a repeated search as those measured
  Tips tips = {};           ///< of the predicted choice
  double tips_seconds = 0;  ///< for finding the tips; not part of choosing
  std::optional<Analysis> analysis = {};
  Rigor rigor = Rigor::estimate;  ///< reached, with the analysis
  CostTable costs = {};
  std::string costs_origin = {};
  double evidence_seconds = 0;        ///< for measuring rays and discs, as far as the choice needs it
  double shown_evidence_seconds = 0;  ///< the same where only the reader needs it, beside a pilot
  double choosing_seconds = 0;        ///< with evidence and pilot
  Whole whole = {};                   ///< of `detp run` with the predicted choice
  std::optional<RanksAnswer> ranks = {};
  std::optional<sim::Progress> stopped = {};  ///< if a stop request ended the work early

  /// Counted in a sample of rays, not by closed forms alone.
  [[nodiscard]] bool by_sample() const { return choice.rigor != Rigor::estimate; }
  /// The fastest measured candidate; null without one.
  [[nodiscard]] const Analysed* fastest() const { return analysis ? analysis->fastest() : nullptr; }
  /// The standard error of the choice's predicted seconds, as far as it is known: of closed forms, that of unit costs.
  [[nodiscard]] double error() const {
    const Prediction& best = choice.best();
    return by_sample() ? best.error : best.seconds() * costs.relative_error_of(best.candidate.technique);
  }
};

/// Makes the job, chooses, looks for tips, and runs the candidates if that is asked for.
///
/// Throws as make_job, choose and analyse; std::invalid_argument for times that are 0 or not finite with
/// these costs, and for ranks that share rays of a file; sim::Stopped if a stop request ended a pilot. A later stop request leaves
/// a partial answer.
[[nodiscard]] ChooseAnswer answer(const ChooseRequest& request, const std::stop_token& stop = {},
                                  const sim::ReportPhase& progress = {});

/// What RanksRequest asks, for the choice of an answer. Times the making of some rays. Of sharing rays or discs, chooses the faster
/// one that fits in memory. Throws std::invalid_argument for rays of a file.
[[nodiscard]] RanksAnswer choose_ranks(const RanksRequest& request, const ChooseAnswer& answer,
                                       const std::stop_token& stop);

/// What takes most of the time: "ray-disc tests".
[[nodiscard]] std::string_view largest_part(const CostBreakdown& time);

/// A candidate of the answer. It refers to the answer.
struct ChooseRow {
  std::string_view role;  ///< "choice", "predicted choice", "candidate" or "paper rule"
  Candidate candidate;
  Engine engine;
  int threads;                                 ///< of prediction and runs
  const Prediction* predicted = nullptr;       ///< null: it has none
  const Prediction* sampled = nullptr;         ///< what a pilot predicted, with its errors; null if none did
  const Analysed* run = nullptr;               ///< null without an analysis
  std::optional<PredictionError> missed = {};  ///< if it was predicted, counted and timed
  std::string not_run = {};                    ///< why it was not timed; empty if it was
  std::string why_not = {};                    ///< why it is not the choice; empty if it is
  /// its predicted time cannot be told apart from that of the predicted choice
  bool could_win = false;

  [[nodiscard]] bool chosen() const { return role == "choice"; }
  /// The standard error of the predicted time, seconds; 0 if a pilot did not predict it.
  [[nodiscard]] double error() const { return sampled != nullptr ? sampled->error : 0; }
};

/// In the order of the ranking. After an analysis, the other candidates that were tried follow.
[[nodiscard]] std::vector<ChooseRow> rows_of(const ChooseAnswer& answer);

/// That of the paper's rule.
[[nodiscard]] ChooseRow paper_row(const ChooseAnswer& answer);

/// Of the rows whose prediction is explained: the predicted choice, and the fastest candidate if it is another one.
[[nodiscard]] std::vector<ChooseRow> explained_rows(const ChooseAnswer& answer);

/// Of the whole answer: JSON, and the last columns of the table.
[[nodiscard]] const Fields<ChooseAnswer>& choose_fields();

/// Of a candidate: `candidates` in JSON, and the rows of the table.
[[nodiscard]] const Fields<ChooseRow>& choose_row_fields();

/// Of a candidate whose prediction is explained: `missed` in JSON.
[[nodiscard]] const Fields<ChooseRow>& missed_fields();

/// Of --ranks: `ranks` in JSON.
[[nodiscard]] const Fields<RanksAnswer>& ranks_fields();

/// What the fields of the answer and of its rows mean.
[[nodiscard]] std::vector<FieldText> describe_choose();

}  // namespace detp::validate
