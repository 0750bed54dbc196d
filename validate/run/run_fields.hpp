#pragma once

#include "detp/validate/base/fields.hpp"
#include "run.hpp"

/// The fields of the answer of `detp run`.
namespace detp::validate {

/// A run, as it is shown.
struct ShownRun {
  const Job& job;
  const RunAnswer& answer;
  std::optional<Whole> whole_measured = {};  ///< of a command that does nothing else
};

/// Hits, counts and seconds, and the predictions of the candidate's closed form if it has one. A stopped run has no
/// `hits` and no irradiance. It has `hits_so_far`, the hits of the finished rays or discs, and if random rays were
/// finished, `hits_estimate` for all rays. Tables have columns of the workload before these.
[[nodiscard]] const Fields<ShownRun>& run_fields();

}  // namespace detp::validate
