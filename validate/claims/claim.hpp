#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
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
};

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
  /// Relative error of the negative control, with its sign. The control is the prediction, changed by the detectable
  /// error (and by one more count if the observation is exact), away from the observation. A change towards the
  /// observation could make a slightly wrong prediction right.
  double control_offset = 0;
  double control = 0;
  Verdict control_verdict = Verdict::undecided;  ///< should be `refuted`
  std::uint64_t lines = 0;
  double seconds = 0;
};

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
[[nodiscard]] std::vector<Claim> judge_all(const std::vector<Finding>& findings, double budget = 1e-3);

}  // namespace detp::validate
