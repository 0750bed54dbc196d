#pragma once

#include <optional>
#include <string>
#include <vector>

#include "choose_ranks.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/sim/effects/observe.hpp"
#include "detp/validate/choice/analysis.hpp"
#include "detp/validate/choice/choice.hpp"
#include "detp/validate/choice/tips.hpp"
#include "detp/validate/cli/report/whole_report.hpp"
#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/cli/text/screen.hpp"

namespace detp::cli {

struct ChooseAnswer {
  std::string title;  ///< first lines of the text: scene and rays
  Workload workload;
  std::vector<sim::EffectReport> effects;
  validate::Choice choice;  ///< predicted
  Prediction paper;         ///< the paper's rule of thumb
  double brute_force = 0;   ///< predicted seconds of testing all pairs
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
