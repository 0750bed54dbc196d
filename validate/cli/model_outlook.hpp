#pragma once

#include "model_answer.hpp"
#include "table.hpp"

/// What follows from the closed forms beside counts and times: how the time grows with more samples, and how accurate
/// the estimates are.
namespace detp::cli {

/// Options of these answers.
struct OutlookOptions {
  std::optional<double> curvature;     ///< ∇²f/f of the density f of the hits, 1/length²
  std::optional<double> target_error;  ///< relative

  void add_to(CLI::App& command);
};

/// Names of the numbers, in their order.
[[nodiscard]] const Columns& outlook_columns();

/// Orders of growth, where they are known; the deviation of a uniform field, where a disc fits S₀; the error where the
/// density is curved, if a curvature is given; and the rays for the target error. Throws std::invalid_argument for
/// options out of range.
[[nodiscard]] Json outlook(const ModelQuestion& question, const Parameters& parameters, const OutlookOptions& options);

}  // namespace detp::cli
