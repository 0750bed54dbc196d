#pragma once

#include <optional>

#include "detp/validate/cli/report/whole_report.hpp"
#include "run_report.hpp"

/// What a run was predicted to take, and its whole wait.
namespace detp::cli {

/// The counts of the choice come from a pilot. Of brute force it knows all but the hits.
[[nodiscard]] bool is_predicted(const RunAnswer& answer);

/// The paper has formulas for the technique's counts.
[[nodiscard]] bool is_published(Technique technique);

/// Those of the paper's formulas if they are requested. Else the counts that a pilot predicted, or else the closed form on this workload: the job's, or what is known of it without measuring. Nothing if the
/// candidate has none, and of other estimators and runs until an error.
[[nodiscard]] std::optional<Counts<double>> prediction(const Workload& workload, const RunAnswer& answer);

/// Of the whole command: of pairs from such counts, of estimators that look at photons by AccuracyCosts and the hits expected of closed forms.
/// Nothing for backward paths, whose rays are known only by a pilot (`accuracy`), and for runs until an error.
[[nodiscard]] std::optional<Whole> predicted_whole(const validate::Job& job, const RunAnswer& answer,
                                                   const std::optional<Counts<double>>& counts);

/// Until now.
[[nodiscard]] Whole measured_whole(const validate::Job& job, const RunAnswer& answer);

}  // namespace detp::cli
