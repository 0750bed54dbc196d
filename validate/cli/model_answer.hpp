#pragma once

#include "command.hpp"
#include "detp/model/vocabulary/form.hpp"
#include "workload_options.hpp"

/// What the closed forms say of each technique, as the `model` command shows it.
namespace detp::cli {

/// A resolved question to the closed forms.
struct ModelQuestion {
  Workload workload;
  Technique technique;
  model::Form form;
  UnitCosts costs;
  std::int64_t levels;
  const CandidateOptions& options;
};

/// The technique's parameters, complete, and what JSON shows.
struct ModelAnswer {
  Parameters parameters;
  Json json;
};

[[nodiscard]] ModelAnswer sphere_cache_answer(const ModelQuestion& question);

/// Any technique with a closed form: parameters, times by part, counts. Parameters left out are the best at the unit
/// costs.
[[nodiscard]] ModelAnswer technique_answer(const ModelQuestion& question);

/// The same with the spheres of each level.
[[nodiscard]] ModelAnswer cell_spheres_answer(const ModelQuestion& question);
[[nodiscard]] ModelAnswer sphere_tree_answer(const ModelQuestion& question);

[[nodiscard]] ModelAnswer octree_answer(const ModelQuestion& question);
[[nodiscard]] ModelAnswer grid_answer(const ModelQuestion& question);

/// Throws std::invalid_argument where the published form is asked for and the paper has none.
void refuse_published(const ModelQuestion& question);

}  // namespace detp::cli
