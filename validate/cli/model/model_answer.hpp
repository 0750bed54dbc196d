#pragma once

#include "detp/model/vocabulary/form.hpp"
#include "detp/validate/cli/options/candidate_options.hpp"
#include "detp/validate/cli/text/result.hpp"

/// The results of the closed forms for each technique, as the `model` command shows them.
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

/// Throws std::invalid_argument if the published form is requested but the paper has none for the technique.
void refuse_published(const ModelQuestion& question);

}  // namespace detp::cli
