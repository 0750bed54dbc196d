#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "detp/sim/effects/observe.hpp"
#include "detp/validate/base/fields.hpp"
#include "detp/validate/choice/candidate_json.hpp"
#include "detp/validate/job/job.hpp"
#include "detp/validate/whole/whole.hpp"

/// Parts that several answers have, in JSON and as columns of tables: rays and discs, candidates, counts, effects, light, the whole wait.
namespace detp::validate {

/// "isotropic" or "photons".
[[nodiscard]] std::string_view name(sim::Field field);

/// An array of their names.
[[nodiscard]] Json names_json(const std::vector<Technique>& techniques);

/// The parameters under their names, with underscores.
[[nodiscard]] Json to_json(const Workload& workload);

/// Resolved inputs of a workload without a scene.
[[nodiscard]] Json numbers_json(const Workload& workload);

/// The resolved inputs that say where discs and rays come from; file names as the user wrote them.
[[nodiscard]] Json origin_json(const JobRequest& request, const std::string& scene, sim::Field field);

/// Resolved inputs of a job; file names as the user wrote them.
[[nodiscard]] Json to_json(const Job& job, const JobRequest& request);

/// Where light and faces went.
[[nodiscard]] Json light_json(const sim::LightLedger& light);

[[nodiscard]] Json geometry_json(const sim::PolygonCounts& polygons, std::uint64_t normals_made,
                                 std::uint64_t coincident);

/// `light`, where photons were traced, and `geometry` of a scene.
[[nodiscard]] Json ledgers_json(const Job& job);

/// An array with one object for each effect.
[[nodiscard]] Json to_json(const std::vector<sim::EffectReport>& effects);

/// The columns of effect_cells(): for each effect its name (true or false), and the name with "_value".
[[nodiscard]] const Columns& effect_columns();

/// The effects of to_json as cells of a table.
[[nodiscard]] Json effect_cells(const Json& effects);

/// The first columns of every table: rays and discs.
[[nodiscard]] const Columns& workload_columns();

/// `technique` and `parameters`: in tables as text, and each parameter of any technique in a column of its own.
[[nodiscard]] const Fields<Candidate>& candidate_fields();

/// `technique`, `parameters` as text, and one column for each parameter of any technique.
[[nodiscard]] const Columns& candidate_columns();

/// The columns of the parameters, and `more`, each with its place in their JSON: for a field with parameters.
[[nodiscard]] std::vector<Column> parameter_columns(const Columns& more = {});

/// One column for each term of Counts, and `tests`, each after the prefix ("predicted_").
[[nodiscard]] Columns count_columns(const std::string& prefix = "");

/// The cells of the workload's columns, from a command's resolved inputs.
[[nodiscard]] Json workload_cells(const Json& inputs);

[[nodiscard]] Json candidate_cells(const Candidate& candidate);

/// The cells of the columns of counts, from counts in JSON.
[[nodiscard]] Json count_cells(const Json& counts);

/// The key "extrapolated" (true or false), and "extrapolated_because" with the reasons.
[[nodiscard]] Json extrapolated_json(const std::vector<std::string>& reasons);

/// `read`, `trace`, `prepare`, `search`, `total`; the total also has the start of the program and writing.
[[nodiscard]] Json whole_json(const WholeSeconds& seconds);

/// A count for JSON, written without a decimal point.
[[nodiscard]] inline Json whole(double count) { return static_cast<std::int64_t>(count); }
template <class T>
[[nodiscard]] Json to_json(const Counts<T>& counts) {
  Json json;
  for_each_term(counts, [&](std::string_view term, T value) { json[std::string(term)] = value; });
  return json;
}

template <class T>
[[nodiscard]] Json count_cells(const Counts<T>& counts, const std::string& prefix = "") {
  Json cells;
  for_each_term(counts, [&](std::string_view term, T value) { cells[prefix + std::string(term)] = value; });
  cells[prefix + "tests"] = tests(counts);
  return cells;
}

/// The parameters of a candidate, which is null if there is none: in JSON by name; in tables as text, and a column for each parameter of any technique.
template <class Answer, class CandidateOf>
[[nodiscard]] Field<Answer> parameters_field(const std::string& meaning, CandidateOf candidate) {
  const Columns names(candidate_columns().begin() + 1, candidate_columns().end());
  return Field<Answer>("parameters", "", meaning,
                       [candidate](const Answer& answer) {
                         const Candidate* const one = std::invoke(candidate, answer);
                         return one != nullptr ? to_json(*one) : Json::object();
                       })
      .by(names, [candidate](const Answer& answer, const Json& parameters) {
        const Candidate* const one = std::invoke(candidate, answer);
        if (one == nullptr) return Json::object();
        Json cells = parameters;
        cells["parameters"] = describe(*one);
        return cells;
      });
}

/// The effects in JSON; their columns.
template <class Answer, class Value>
[[nodiscard]] Field<Answer> effects_field(Value value) {
  return Field<Answer>("effects", "", "deviations from uniform lines and samples, with the evidence for each", value)
      .by(effect_columns(), [](const Answer&, const Json& effects) { return effect_cells(effects); });
}

}  // namespace detp::validate
