#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "claim.hpp"
#include "detp/validate/base/fields.hpp"
#include "detp/validate/job/job.hpp"
#include "detp/validate/sweep/sweep.hpp"
#include "findings_until.hpp"

/// What `detp validate` does: an experiment for each formula, on uniform samples or in a scene, with a verdict; on request over the whole range
/// of each formula.
namespace detp::validate {

struct ValidateRequest {
  /// A scene, files, or numbers: by default a million lines, 20 000 samples, discs of radius 0.02, a cube of side 2.
  JobRequest job;
  std::vector<std::string> experiments = {};  ///< ExperimentStep::key of some; empty: all
  std::vector<double> ratios = {};            ///< Q of sphere caches, each in (0, 1); empty: those of Experiment
  std::optional<Form> form = {};              ///< of the claims that are shown; all are judged
  std::optional<FindingsTarget> until = {};   ///< counts so long; nothing: the usual number of lines
  std::optional<double> sweep_samples = {};   ///< also the sweep, but for workloads of more samples
  std::optional<std::filesystem::path> checkpoint = {};  ///< of the sweep, or of `until`
  bool resume = false;                                   ///< goes on from the checkpoint
  sim::Ranks* ranks = nullptr;                           ///< that have the same request; null: this process alone
  std::function<void(const Job&)> made = {};             ///< called when the job in a scene is made, before the work
};

struct ValidateAnswer {
  Json inputs;                  ///< as resolved
  Json scene = Json::object();  ///< warnings, light and geometry of a scene
  std::vector<sim::EffectReport> effects = {};
  std::vector<Finding> findings = {};
  Claims claims = {};  ///< predictions of all findings
  Claims shown = {};   ///< those of the form asked for
  std::optional<SweepResult> sweep = {};
  std::optional<sim::Progress> stopped = {};  ///< by a stop request
  bool not_reached = false;                   ///< more lines would be needed for FindingsTarget::relative_error

  /// A corrected form is refuted, or a negative control missed. A refuted published form does not matter.
  [[nodiscard]] bool refuted() const;
};

/// Throws std::invalid_argument for a request that contradicts itself or is out of range; std::length_error for more than 10⁷ samples; as
/// make_job, run_sweep and findings_until. On ranks other than 0, helps rank 0 and returns an empty answer.
[[nodiscard]] ValidateAnswer answer(const ValidateRequest& request, const std::stop_token& stop = {},
                                    const sim::ReportPhase& progress = {});

[[nodiscard]] const Fields<Claim>& claim_fields();
/// What the list of fields says: of claims, of the sweep's summaries and of its rows.
[[nodiscard]] std::vector<FieldText> describe_validate();

/// All but the inputs.
[[nodiscard]] Json json_of(const ValidateAnswer& answer);

/// A table with a row for each claim that is shown, and for each comparison of the sweep.
[[nodiscard]] Columns validate_columns();
[[nodiscard]] std::vector<Json> validate_rows(const ValidateAnswer& answer);

}  // namespace detp::validate
