#pragma once

#include <string>

#include "command.hpp"
#include "detp/model/choose.hpp"
#include "detp/validate/job.hpp"
#include "value_lists.hpp"

namespace detp::cli {

/// The options that name rays and discs (or a workload in numbers). The parser points into it.
class WorkloadOptions {
 public:
  WorkloadOptions() = default;
  WorkloadOptions(const WorkloadOptions&) = delete;
  WorkloadOptions& operator=(const WorkloadOptions&) = delete;

  void add_to(CLI::App& command, Values values = Values::one);

  ValueLists lists;  ///< of the options that may have many values

  /// What the chosen row asks for. Throws std::invalid_argument for options that do not go together.
  [[nodiscard]] validate::JobRequest request(const CommonOptions& common) const;

 private:
  validate::JobRequest request_;
};

/// Where a sphere cache stops that is not given its k.
enum class SphereStop {
  max,  ///< at the form's own k
  best  ///< where it is fastest, by the model
};

/// The options that name a technique and its parameters; those left out are filled in. The parser points into it.
class CandidateOptions {
 public:
  CandidateOptions() = default;
  CandidateOptions(const CandidateOptions&) = delete;
  CandidateOptions& operator=(const CandidateOptions&) = delete;

  void add_to(CLI::App& command, Values values, SphereStop default_stop);

  ValueLists lists;  ///< of the options that may have many values
  std::optional<std::string> technique;
  std::optional<double> ratio;
  std::optional<std::int64_t> spheres;
  std::optional<SphereStop> stop;  ///< instead of the number of spheres
  std::string order = "lebesgue";
  std::optional<int> depth;
  std::optional<std::string> traversal;
  std::optional<int> cells;
  std::optional<int> fan_out;
  std::optional<int> leaf;
  std::optional<std::string> quality;
  std::optional<int> nearest;
  std::optional<std::string> bounds;

  /// The technique of that name, or `otherwise`. Throws std::invalid_argument for an unknown one, naming the known.
  [[nodiscard]] Technique technique_or(Technique otherwise) const;
  [[nodiscard]] SampleOrder sample_order() const;
  [[nodiscard]] BvhParameters bvh() const;
  [[nodiscard]] PhotonMapParameters photon_map() const;

  /// The traversal of that name, or the octree's own. Throws std::invalid_argument for an unknown one, naming the
  /// known.
  [[nodiscard]] Traversal chosen_traversal() const;

  /// What is given of a sphere tree.
  [[nodiscard]] model::TreeWish tree_wish() const;

  /// Throws std::invalid_argument for a parameter given that the technique does not have.
  void refuse_foreign(Technique technique) const;

 private:
  void set_spheres(const std::string& text);
};

/// "isotropic" or "photons".
[[nodiscard]] std::string_view name(sim::Field field);

[[nodiscard]] Json to_json(const Parameters& parameters);
[[nodiscard]] Json to_json(const Workload& workload);

/// Resolved inputs of a workload given in numbers alone.
[[nodiscard]] Json numbers_json(const Workload& workload);

/// A count as JSON writes it: a whole number without a point.
[[nodiscard]] inline Json whole(double count) { return static_cast<std::int64_t>(count); }
template <class T>
[[nodiscard]] Json to_json(const Counts<T>& counts) {
  Json json;
  for_each_term(counts, [&](std::string_view term, T value) { json[std::string(term)] = value; });
  return json;
}

/// Resolved inputs of a job; the files as they were asked for.
[[nodiscard]] Json to_json(const validate::Job& job, const validate::JobRequest& request);

/// The deviations from the plain model that this workload shows and the closed forms take into account.
[[nodiscard]] Json effects_json(const Workload& workload);

/// The same as cells of a table: "finite_paths" (true or false) and "finite_paths_evidence" of each effect.
[[nodiscard]] Json effect_cells(const Json& effects);

/// Notices and warnings of a job, on stderr.
void note_all(const CommonOptions& common, const validate::Job& job);

/// "scene" and "rays" lines of the text output.
[[nodiscard]] std::string describe(const validate::Job& job);

}  // namespace detp::cli
