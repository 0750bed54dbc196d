#include "candidate_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "detp/model/rank/choose.hpp"
#include "detp/model/vocabulary/quoted.hpp"

namespace detp {
namespace {

/// Whole numbers are values of ratios, too: JSON does not tell 1 from 1.0.
ParameterValue value_of(const nlohmann::ordered_json& json, const Parameter& parameter) {
  if (std::holds_alternative<double>(parameter.small) && json.is_number()) return json.get<double>();
  if (std::holds_alternative<std::int64_t>(parameter.small) && json.is_number_integer() &&
      !(json.is_number_unsigned() && json.get<std::uint64_t>() > INT64_MAX))
    return json.get<std::int64_t>();
  if (json.is_string())
    for (const std::string_view choice : parameter.choices)
      if (choice == json.get_ref<const std::string&>()) return choice;
  throw std::invalid_argument(
      fmt::format("{} cannot be {}", parameter.what,
                  shortened(json.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace))));
}

}  // namespace

nlohmann::ordered_json to_json(const Candidate& candidate) {
  auto json = nlohmann::ordered_json::object();
  for (const Parameter& parameter : record_of(candidate.technique).parameters) {
    std::string key(parameter.name);
    std::replace(key.begin(), key.end(), '-', '_');
    std::visit([&](const auto& value) { json[key] = value; }, parameter.get(candidate.parameters));
  }
  return json;
}

model::FixedParameters fixed_parameters_of(Technique technique, const nlohmann::ordered_json& parameters) {
  if (!parameters.is_object()) throw std::invalid_argument("the parameters must be an object");
  model::FixedParameters fixed;
  for (const auto& [key, value] : parameters.items()) {
    std::string parameter_name = key;
    std::replace(parameter_name.begin(), parameter_name.end(), '_', '-');
    const Parameter* const parameter = find_parameter(technique, parameter_name);
    if (parameter == nullptr)
      throw std::invalid_argument(fmt::format("{} is no parameter of {}", detp::quoted(key), name(technique)));
    fixed.values.emplace_back(parameter->name, value_of(value, *parameter));
  }
  return fixed;
}

Candidate candidate_of(Technique technique, const nlohmann::ordered_json& parameters) {
  return model::candidate_with(technique, fixed_parameters_of(technique, parameters));
}

}  // namespace detp
