#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/validate/claims/claim.hpp"
#include "detp/validate/claims/findings_until.hpp"
#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/cli/text/screen.hpp"
#include "detp/validate/cli/text/table.hpp"
#include "detp/validate/sweep/sweep.hpp"

/// The parts of the answer of `detp validate`: what the verdicts on claims come to, `--until-relative-error`, and the sweep.
namespace detp::cli {

using Claims = std::vector<validate::Claim>;

/// "rebuild-time" of the id "rebuild-time.corrected".
[[nodiscard]] std::string stem(const validate::Claim& claim);

/// The verdict on a negative control, which should be refuted: `caught` if it was, `missed` if the wrong formula agrees
/// with the counts, else `undecided`.
[[nodiscard]] std::string_view control_name(validate::Verdict verdict);

/// True if the claim is a published form that was refuted, and the corrected form of the same quantity predicts another
/// number. The header of the corrected form then says what is wrong in the published one.
[[nodiscard]] bool is_documented(const validate::Claim& claim, const Claims& claims);

/// `refuted` if a corrected form is refuted or a negative control missed. A refuted published form does not matter.
[[nodiscard]] ExitCode code_of(const Claims& claims);

/// The numbers of verdicts on corrected forms, published forms, controls and the predictions of the choice.
[[nodiscard]] Json claim_summary_json(const Claims& claims);

/// The answer of `validate` in a few lines: how many predictions are refuted; on a scene, which predictions of the choice,
/// of other techniques and of the formulas; the published forms; the negative controls.
[[nodiscard]] std::string summary_text(const Claims& claims, const Screen& screen);

struct ClaimsUntilOptions {
  std::optional<std::string> relative_error;
  std::optional<std::string> confidence;
  std::optional<double> least_lines;
  std::optional<double> most_lines;

  /// Nothing if claims are judged after their usual number of lines. Throws std::invalid_argument for numbers out of range, and for options
  /// without --until-relative-error.
  [[nodiscard]] std::optional<validate::FindingsTarget> target() const;
};

/// findings_until, with a checkpoint if there is a file for it. Throws as findings_until and CheckpointFile.
[[nodiscard]] validate::FindingsUntil find_until(const validate::Experiment& experiment,
                                                 const validate::FindingsTarget& target,
                                                 std::span<const validate::ExperimentStep> steps,
                                                 const std::optional<std::filesystem::path>& checkpoint, bool resume,
                                                 const sim::ReportPhase& progress, const std::stop_token& stop);

/// How far the finding with this id got: the members that its claims have in addition.
[[nodiscard]] Json refinement_json(const validate::FindingsUntil& until, const std::string& id);

/// Adds the inputs, the line "errors", and whether all errors were reached.
void add_until(const validate::FindingsUntil& until, const validate::FindingsTarget& target, Result& result);

/// The columns of a sweep's comparison that a claim does not have.
[[nodiscard]] Columns sweep_columns();

/// Adds a sweep to a command's result: a summary for each quantity ("sweep" in JSON, a table in the text), and every
/// comparison as a row of the table.
void report_sweep(const validate::SweepResult& sweep, const Screen& screen, Table& table, Result& result);

/// Writes the comparisons as CSV: one row for each compared count, with the predictions of both forms. Counts that are
/// the same in every set and equal their prediction are left out. Predictions and observations have five digits,
/// standard errors two. Throws sim::FileError.
void write_sweep_rows(const std::string& path, const std::vector<validate::Deviation>& deviations,
                      const std::stop_token& stop = {});

}  // namespace detp::cli
