#pragma once

#include "detp/validate/cli/text/table.hpp"
#include "model_answer.hpp"

/// Results of the closed forms in addition to counts and times: how the time grows with the number of samples, and how
/// accurate the estimates are.
namespace detp::cli {

struct OutlookOptions {
  std::optional<double> curvature;     ///< ∇²f/f of the density f of the hits, 1/length²
  std::optional<double> target_error;  ///< relative

  /// The target error may have several values, which go to `lists`.
  void add_to(CLI::App& command, ValueLists& lists);

  [[nodiscard]] bool given() const { return curvature || target_error; }
};

/// Names of the results that say how accurate the estimates are.
[[nodiscard]] const Columns& error_columns();

/// Names of all results, in their order.
[[nodiscard]] const Columns& outlook_columns();

/// The orders of growth if D >= 2; the deviation of irradiance in a uniform field if the rays are lines, both faces
/// count and a disc fits in S₀, else that of a disc with the mean number of hits; the error for a curved density if a
/// curvature is set; if a target error is set, the numbers of rays for it, and `notes`: what these numbers mean. Throws
/// std::invalid_argument for options out of range.
[[nodiscard]] Json outlook(const ModelQuestion& question, const Parameters& parameters, const OutlookOptions& options);

}  // namespace detp::cli
