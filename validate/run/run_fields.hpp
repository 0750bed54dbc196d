#pragma once

#include "detp/model/optimum/best_ratio.hpp"
#include "detp/validate/base/fields.hpp"
#include "run.hpp"

/// The fields of the answer of `detp run`.
namespace detp::validate {

/// A run, as it is shown.
struct ShownRun {
  const Job& job;
  const RunAnswer& answer;
  std::optional<Counts<double>> predicted = {};
  std::optional<Whole> whole = {};               ///< predicted
  std::optional<Whole> whole_measured = {};      ///< of a command that does nothing else
  std::optional<model::SphereStops> stops = {};  ///< of a sphere cache, by the form of its technique
  std::optional<SeenBetween> picture = {};
};

/// Measures the job, if it was not. Job and answer must stay.
[[nodiscard]] ShownRun shown_run(const Job& job, const RunAnswer& answer, std::optional<Whole> whole_measured = {});

/// Hits, counts and seconds, and the predictions of the candidate's closed form if it has one. A stopped run has no
/// `hits` and no irradiance. It has `hits_so_far`, the hits of the finished rays or discs, and if random rays were
/// finished, `hits_estimate` for all rays. Tables have columns of the workload before these.
[[nodiscard]] const Fields<ShownRun>& run_fields();

}  // namespace detp::validate
