#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>

#include "detp/validate/claims/findings_until.hpp"
#include "detp/validate/cli/text/result.hpp"

/// `detp validate --until-relative-error`.
namespace detp::cli {

struct UntilOptions {
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

}  // namespace detp::cli
