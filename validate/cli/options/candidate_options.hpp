#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/estimate/estimator.hpp"
#include "value_lists.hpp"

/// What is searched, and how: a technique, its parameters, engine and instruction set.
namespace detp::cli {

/// The number of spheres k of a sphere cache if --spheres is not a number.
enum class SphereStop {
  max,  ///< model::SphereStops::max
  best  ///< model::SphereStops::best
};

/// The help of --engine.
inline constexpr const char* engine_help =
    "simd: vectors of floats, with exact decisions; plain: in double, one ray and one disc at a time; the hits are the "
    "same; default: simd";

/// Throws std::invalid_argument for an unknown name.
[[nodiscard]] Engine parse_engine(const std::string& text);

/// Throws std::invalid_argument for an unknown name, listing the known names.
[[nodiscard]] Technique parse_technique(const std::string& text);

/// Throws std::invalid_argument for an unknown name, listing the known names.
[[nodiscard]] sim::Estimator parse_estimator(const std::string& text);

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

  /// All parameters that are set.
  [[nodiscard]] model::FixedParameters given() const { return {{given_.begin(), given_.end()}}; }
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

/// --instruction-set: what other machines would do.
class InstructionSetOption {
 public:
  void add_to(CLI::App& command, const std::string& whose);

  /// The sets in the order given; one empty name, all that the machine has, if none was given. Throws std::invalid_argument for a set that
  /// the kernels were not compiled for, or that this machine lacks.
  [[nodiscard]] std::vector<std::string> sets() const;

  /// The only set. Throws std::invalid_argument if several were given, too.
  [[nodiscard]] std::string only() const;

 private:
  std::vector<std::string> sets_;
};

}  // namespace detp::cli
