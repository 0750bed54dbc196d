#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/geometry/geometry.hpp"
#include "detp/sim/ranks/ranks.hpp"
#include "detp/validate/statistics/statistics.hpp"

/// Claims: predictions of formulas, compared with counts.
namespace detp::validate {

struct FormulaValue {
  Form form;
  std::string source;  ///< equation of the paper, or "our derivation"
  double value = 0;
};

/// How far a finding got that is counted until its error is small enough.
struct Refinement {
  double relative_error = 0;  ///< half width of the interval over the observed value; not finite if nothing was met
  bool reached = false;
  /// That the target would still take, by the error so far; infinite if nothing was met. Nothing if the target is reached, or if the
  /// finding counts on given rays.
  std::optional<double> more_lines = {};
  std::optional<double> more_seconds = {};
  /// If nothing was met: bound of the share of lines that meet anything, -ln(error allowed to this finding)/lines. Holds if lines are
  /// independent.
  std::optional<double> share_bound = {};
};

/// A counted quantity, and the formulas' predictions of it.
struct Finding {
  std::string id;               ///< "rebuild-time"
  std::string quantity;         ///< "T_R per ray, t = 1: geometric mean over Q = 0.3, 0.5, 0.65, 0.8"
  std::string technique = {};   ///< "sphere-cache"; empty if the claim is about lines alone
  std::string parameters = {};  ///< "Q 0.65, k 9"; empty if the claim is about several candidates or none
  std::vector<FormulaValue> predictions = {};
  Estimate observed = {};
  int batches = 0;       ///< independent batches from which the standard error is computed; 0: `observed` is exact
  double tolerance = 0;  ///< relative difference of prediction and observation that still counts as agreement
  std::uint64_t lines = 0;
  double seconds = 0;
  std::optional<Refinement> refinement = {};  ///< if it was counted until its error was small
};

/// A prediction of a finding, judged.
struct Claim {
  std::string id;  ///< "rebuild-time.corrected"
  std::string quantity;
  std::string technique;   ///< as in the finding
  std::string parameters;  ///< as in the finding
  Form form;
  std::string source;
  double predicted = 0;
  Estimate observed = {};
  double relative_difference = 0;  ///< observed/predicted - 1
  double tolerance = 0;
  double detectable = 0;  ///< relative error of the formula that would be refuted with a probability of 97 %
  Verdict verdict = Verdict::undecided;
  /// A published form that is refuted, where the corrected form of the same quantity predicts another number. The header of the corrected
  /// form then says what is wrong in the published one.
  bool documented = false;
  /// Relative error of the negative control, with its sign. The control is the prediction, changed by the detectable
  /// error (and by one more count if the observation is exact), away from the observation. A change towards the
  /// observation could make a slightly wrong prediction right.
  double control_offset = 0;
  double control = 0;
  Verdict control_verdict = Verdict::undecided;  ///< should be `refuted`
  std::uint64_t lines = 0;
  double seconds = 0;
  std::optional<Refinement> refinement = {};  ///< as in the finding

  /// "rebuild-time" of the id "rebuild-time.corrected".
  [[nodiscard]] std::string stem() const { return id.substr(0, id.rfind('.')); }
};

using Claims = std::vector<Claim>;

/// The input of `choose`. The predictions of `choose` for this input are claims too.
struct ChoiceQuestion {
  Workload workload;           ///< as `choose` measures it
  std::vector<sim::Ray> rays;  ///< at least one
  std::string effects = {};    ///< that the workload takes into account: "finite paths, surface samples"
};

struct Experiment {
  Workload workload;                          ///< the formulas' input; the rays are lines
  std::vector<sim::Disc> discs;               ///< of a scene; if empty, uniform discs are drawn as the workload says
  std::optional<ChoiceQuestion> choice = {};  ///< if the experiment is on a scene
  std::vector<double> ratios = {0.3, 0.5, 0.65, 0.8};  ///< Q of sphere caches
  std::uint64_t seed = 1;
  std::stop_token stop = {};
  sim::Ranks* ranks = nullptr;  ///< that have the same experiment; null: this process alone
};

/// Judges all predictions of all findings. The probability of any false verdict in the result is below `budget`.
[[nodiscard]] Claims judge_all(const std::vector<Finding>& findings, double budget = 1e-3);

/// The verdict on a negative control, which should be refuted: `caught` if it was, `missed` if the wrong formula agrees with the counts, else
/// `undecided`.
[[nodiscard]] std::string_view control_name(Verdict verdict);

/// Some of the claims, in their order.
[[nodiscard]] Claims those(const Claims& claims, const std::function<bool(const Claim&)>& condition);
[[nodiscard]] Claims with_form(const Claims& claims, Form form);
[[nodiscard]] Claims with_verdict(const Claims& claims, Verdict verdict);
/// Those whose id begins so: "effects.".
[[nodiscard]] Claims starting_with(const Claims& claims, const std::string& start);

/// The techniques whose predictions by `choose` are claims, the fastest first; empty without a scene.
[[nodiscard]] std::vector<std::string> judged_candidates(const Claims& claims);
/// The predictions of `choose` for a technique.
[[nodiscard]] Claims of_candidate(const Claims& claims, const std::string& technique);

/// How many negative controls have this verdict.
[[nodiscard]] std::size_t controls(const Claims& claims, Verdict verdict);

}  // namespace detp::validate
