#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/model/rank/choose.hpp"
#include "detp/model/ranks/ranks.hpp"
#include "detp/sim/effects/observe.hpp"
#include "detp/validate/choice/analysis.hpp"
#include "detp/validate/choice/choice.hpp"
#include "detp/validate/choice/tips.hpp"
#include "detp/validate/cli/report/prediction_report.hpp"
#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/cli/text/screen.hpp"
#include "detp/validate/job/job.hpp"

/// The answer of `detp choose`, and of `detp choose --ranks`: what processes that share a run take.
namespace detp::cli {

struct RanksOptions {
  std::optional<double> ranks;
  double bytes_per_second = model::Network{}.bytes_per_second;
};

/// The time for making all rays and checking them, from some of them.
struct MakingTime {
  double seconds = 0;
  double error = 0;  ///< standard error
};

/// Times further rays of a job, which has its scene if they are photon paths. Throws std::invalid_argument for rays of a file.
[[nodiscard]] MakingTime making_time(const validate::Job& job, const std::stop_token& stop);
/// Times lines, as many as a workload has.
[[nodiscard]] MakingTime making_time(const Workload& workload, std::uint64_t seed, const std::stop_token& stop);

struct RanksAnswer {
  double ranks = 1;
  model::Network network;
  bool by_rays = true;  ///< what is chosen
  bool fits = true;     ///< in a rank's memory
  double memory_limit = 0;
  model::SharedTime rays;
  model::SharedTime discs;
  double alone = 0;  ///< seconds of one process
  double error =
      0;  ///< of the chosen time, as far as it is known: the prediction's of the search, the standard error of making rays

  [[nodiscard]] const model::SharedTime& best() const { return by_rays ? rays : discs; }
};

/// `search_error`: of the predicted seconds. `costs`: of the predicted technique. Chooses the faster of those that fit in memory.
[[nodiscard]] RanksAnswer choose_ranks(const RanksOptions& options, const Workload& workload, double photons_per_ray,
                                       bool photon_paths, double triangles, const Prediction& prediction,
                                       double search_error, const MakingTime& making, const UnitCosts& costs);

[[nodiscard]] Json to_json(const RanksAnswer& answer);
[[nodiscard]] std::string ranks_line(const RanksAnswer& answer);

struct ChooseAnswer {
  std::string title;  ///< first lines of the text: scene and rays
  Workload workload;
  std::vector<sim::EffectReport> effects;
  validate::Choice choice;  ///< predicted
  Prediction paper;         ///< the paper's rule of thumb
  double brute_force = 0;   ///< predicted seconds of testing all pairs, in a repeated search as those measured
  validate::Tips tips;      ///< of the predicted choice
  double tips_seconds = 0;  ///< for finding the tips; not part of choosing
  std::optional<validate::Analysis> analysis;
  Rigor rigor = Rigor::estimate;  ///< reached, with the analysis
  CostTable costs;
  std::string costs_origin;           ///< "of each operation: built in, ..."
  double evidence_seconds = 0;        ///< for measuring rays and discs, as far as the choice needs it
  double shown_evidence_seconds = 0;  ///< the same where only the reader needs it, beside a pilot
  double choosing_seconds = 0;        ///< with evidence and pilot
  std::vector<std::string> warnings;
  validate::WholeInputs whole = {};  ///< of `detp run`
  Json ledgers = Json::object();     ///< of light and geometry
  std::optional<RanksAnswer> ranks;  ///< of --ranks

  /// Counted in a sample of rays, not by closed forms alone.
  [[nodiscard]] bool by_sample() const { return choice.rigor != Rigor::estimate; }
};

/// Of `detp run` with the predicted choice.
[[nodiscard]] inline Whole whole_of(const ChooseAnswer& answer) {
  const Prediction& best = answer.choice.best();
  const double pilot = answer.by_sample() ? static_cast<double>(answer.choice.sampled_rays) : 0;
  return {validate::whole_seconds(answer.whole, best.time, pilot, best.threads),
          validate::peak_bytes(answer.whole, best.counts.bytes_touched)};
}

[[nodiscard]] Json to_json(const ChooseAnswer& answer);

/// What the text has besides the answer.
struct TextDetail {
  bool verbose = false;   ///< all candidates, what was ruled out, the paper's rule, evidence of effects, legends
  bool measured = false;  ///< of an analysis: a short table of the fastest candidate of each technique
};

/// At most 12 lines of 120 columns without details, for scenes whose name fits on a line. An analysis that is shown begins with its result.
[[nodiscard]] std::string to_text(const ChooseAnswer& answer, const Screen& screen, const TextDetail& detail = {});

/// A row for each ranked candidate, then for each other candidate that was tried, and for the candidate of the paper's
/// rule. The workload's columns come from the resolved inputs.
[[nodiscard]] std::string to_csv(const ChooseAnswer& answer, const Json& inputs);

}  // namespace detp::cli
