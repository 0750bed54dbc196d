#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/validate/choice/candidate_json.hpp"
#include "detp/validate/job/job.hpp"
#include "value_lists.hpp"

namespace detp::cli {

/// The options for rays and discs (or for a workload without a scene). The parser keeps pointers to this object.
class WorkloadOptions {
 public:
  WorkloadOptions() = default;
  WorkloadOptions(const WorkloadOptions&) = delete;
  WorkloadOptions& operator=(const WorkloadOptions&) = delete;

  /// `axes`: of --rays and --disc-radius, if other than that of the rest.
  void add_to(CLI::App& command, Values values = Values::one, std::optional<Values> axes = {});

  ValueLists lists;  ///< of the options that may have many values

  /// The request of the current row. Throws std::invalid_argument for options that exclude each other. If `complete`,
  /// also throws if a number of a workload without a scene is missing.
  [[nodiscard]] validate::JobRequest request(const CommonOptions& common, bool complete = true) const;

 private:
  validate::JobRequest request_;
};

/// Throws std::invalid_argument, naming the option, if a number of a workload without a scene is missing.
void require_numbers(const validate::JobRequest& request);

/// The number of spheres k of a sphere cache if --spheres is not a number.
enum class SphereStop {
  max,  ///< SphereStops::max
  best  ///< SphereStops::best
};

/// "isotropic", "photons", "mixed" or "mixed:0.5:0.25:0.25". Throws std::invalid_argument for other text, and unless shares
/// add up to 1.
[[nodiscard]] std::pair<sim::Field, sim::FieldShares> parse_field(const std::string& text);

/// "area,spot". Throws std::invalid_argument for an unknown kind.
[[nodiscard]] std::vector<sim::LightKind> parse_lights(std::string_view text);

/// "-z"; nothing for "auto". Throws std::invalid_argument for other text.
[[nodiscard]] std::optional<sim::Up> parse_up(const std::string& text);

/// The help of --engine.
inline constexpr const char* engine_help =
    "simd: vectors of floats, with exact decisions; plain: in double, one ray and one disc at a time; the hits are the "
    "same; default: simd";

/// Throws std::invalid_argument for an unknown name.
[[nodiscard]] Engine parse_engine(const std::string& text);

/// Throws std::invalid_argument for an unknown name, listing the known names.
[[nodiscard]] Technique parse_technique(const std::string& text);

/// The options for a technique and its parameters. Commands choose what is not set. The parser keeps pointers to this
/// object.
class CandidateOptions {
 public:
  CandidateOptions() = default;
  CandidateOptions(const CandidateOptions&) = delete;
  CandidateOptions& operator=(const CandidateOptions&) = delete;

  void add_to(CLI::App& command, Values values, SphereStop default_stop);

  ValueLists lists;  ///< of the options that may have many values
  std::optional<std::string> technique;
  std::optional<SphereStop> stop;  ///< used instead of the number of spheres
  Engine engine = Engine::simd;

  /// The technique that the option names, or `otherwise` if it is not set. Throws as parse_technique.
  [[nodiscard]] Technique technique_or(Technique otherwise) const {
    return technique ? parse_technique(*technique) : otherwise;
  }

  /// The parameters that are set. Throws std::invalid_argument for a parameter that the technique does not have.
  [[nodiscard]] model::FixedParameters fixed_parameters(Technique technique) const;

  /// The value of the parameter, which has the type T, or nothing if it is not set.
  template <class T>
  [[nodiscard]] std::optional<T> given(std::string_view parameter) const {
    const auto found = given_.find(parameter);
    return found == given_.end() ? std::nullopt : std::optional(std::get<T>(found->second));
  }

 private:
  void set(const Parameter& parameter, const std::string& text);

  std::map<std::string_view, ParameterValue> given_;
};

/// "isotropic" or "photons".
[[nodiscard]] std::string_view name(sim::Field field);

/// An array of their names.
[[nodiscard]] Json names_json(const std::vector<Technique>& techniques);

/// The parameters under their names, with underscores.
[[nodiscard]] Json to_json(const Workload& workload);

/// Resolved inputs of a workload without a scene.
[[nodiscard]] Json numbers_json(const Workload& workload);

/// A count for JSON, written without a decimal point.
[[nodiscard]] inline Json whole(double count) { return static_cast<std::int64_t>(count); }
template <class T>
[[nodiscard]] Json to_json(const Counts<T>& counts) {
  Json json;
  for_each_term(counts, [&](std::string_view term, T value) { json[std::string(term)] = value; });
  return json;
}

/// The resolved inputs that say where discs and rays come from; file names as the user wrote them.
[[nodiscard]] Json origin_json(const validate::JobRequest& request, const std::string& scene, sim::Field field);

/// Resolved inputs of a job; file names as the user wrote them.
[[nodiscard]] Json to_json(const validate::Job& job, const validate::JobRequest& request);

void note_all(const CommonOptions& common, const validate::Job& job);

/// The lines "scene" and "rays" of the text output.
[[nodiscard]] std::string describe(const validate::Job& job);

}  // namespace detp::cli
