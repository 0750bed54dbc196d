#pragma once

#include "detp/model/vocabulary/form.hpp"
#include "detp/validate/cli/options/candidate_options.hpp"
#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/cli/text/table.hpp"

/// The results of the closed forms for each technique, as the `model` command shows them; in addition to counts and times, how the
/// time grows with the number of samples, and how accurate the estimates are.
namespace detp::cli {

/// Resolved inputs of the closed forms.
struct ModelQuestion {
  Workload workload;
  Technique technique;
  Form form;
  UnitCosts costs;
  std::int64_t levels;
  const CandidateOptions& options;
};

/// The technique's complete parameters, and the content of JSON.
struct ModelAnswer {
  Parameters parameters;
  Json json;
};

[[nodiscard]] ModelAnswer sphere_cache_answer(const ModelQuestion& question);

/// For any technique with a closed form: parameters, times by part, counts. Parameters that are not set get the values
/// with the least predicted time at the unit costs.
[[nodiscard]] ModelAnswer technique_answer(const ModelQuestion& question);

/// As technique_answer, plus the spheres of each level.
[[nodiscard]] ModelAnswer cell_spheres_answer(const ModelQuestion& question);
[[nodiscard]] ModelAnswer sphere_tree_answer(const ModelQuestion& question);

[[nodiscard]] ModelAnswer octree_answer(const ModelQuestion& question);
[[nodiscard]] ModelAnswer grid_answer(const ModelQuestion& question);

/// The answer in sentences: T and its parts, the best parameters, k, and what the other form says. `with_costs`: unit
/// costs were given, so that times are seconds; else they are counts of tests.
[[nodiscard]] std::string model_sentences(const ModelQuestion& question, const ModelAnswer& answer, bool with_costs);

/// The command, to be pasted, that counts what the formulas predict on `workload`, the options of one; empty if there is none.
[[nodiscard]] std::string counting_command(const ModelQuestion& question, const ModelAnswer& answer,
                                           const std::string& workload);

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
