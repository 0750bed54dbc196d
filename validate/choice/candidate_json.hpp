#pragma once

#include <nlohmann/json_fwd.hpp>

#include "detp/model/techniques/registry.hpp"

/// Candidates in JSON. The functions are found by their arguments.
namespace detp {

/// The parameters by name, with underscores: {"fan_out": 8, "leaf": 32}.
[[nodiscard]] nlohmann::ordered_json to_json(const Candidate& candidate);

/// The parameters of a technique in JSON. Throws std::invalid_argument for an unknown parameter, or for a value of another kind.
[[nodiscard]] model::FixedParameters fixed_parameters_of(Technique technique, const nlohmann::ordered_json& parameters);

/// The candidate of a technique with these parameters; those that are not in the JSON have their defaults. Throws
/// std::invalid_argument for an unknown parameter, or for a value that is out of range or of another kind.
[[nodiscard]] Candidate candidate_of(Technique technique, const nlohmann::ordered_json& parameters);

}  // namespace detp
