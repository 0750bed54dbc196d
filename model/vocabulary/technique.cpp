#include "technique.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "checks.hpp"

namespace detp {
namespace {

std::string text_of(const ParameterValue& value) {
  return std::visit([](const auto& shown) { return fmt::format("{}", shown); }, value);
}

void require_in_range(const Parameter& parameter, const ParameterValue& value) {
  if (const auto* real = std::get_if<double>(&value)) return require_ratio(parameter.what, *real);
  if (const auto* whole = std::get_if<std::int64_t>(&value))
    return require_count(parameter.what, static_cast<double>(*whole), parameter.least, parameter.most);
  const auto& names = parameter.choices;
  const auto choice = std::get<std::string_view>(value);
  if (std::find(names.begin(), names.end(), choice) == names.end())
    throw std::invalid_argument(
        fmt::format("{} must be one of {} (got {})", parameter.what, fmt::join(names, ", "), choice));
}

}  // namespace

std::optional<Technique> technique_named(std::string_view wanted) {
  for (const TechniqueRecord& record : technique_records)
    if (record.built && record.name == wanted) return record.technique;
  return std::nullopt;
}

const Parameter* find_parameter(Technique technique, std::string_view wanted) {
  for (const Parameter& parameter : record_of(technique).parameters)
    if (parameter.name == wanted) return &parameter;
  return nullptr;
}

void set_parameter(Candidate& candidate, std::string_view wanted, const ParameterValue& value) {
  const Parameter* parameter = find_parameter(candidate.technique, wanted);
  if (parameter == nullptr)
    throw std::invalid_argument(fmt::format("{} is no parameter of {}", wanted, name(candidate.technique)));
  if (parameter->small.index() != value.index())
    throw std::invalid_argument(fmt::format("{} cannot be {}", parameter->what, text_of(value)));
  require_in_range(*parameter, value);
  parameter->set(candidate.parameters, value);
}

std::string describe(const Candidate& candidate) {
  const TechniqueRecord& record = record_of(candidate.technique);
  std::string text;
  for (const Parameter& parameter : record.parameters) {
    const ParameterValue value = parameter.get(candidate.parameters);
    if (!parameter.choices.empty() && record.parameters.size() > 1 && value == parameter.get(record.defaults)) continue;
    if (!text.empty()) text += ", ";
    if (const auto* real = std::get_if<double>(&value))
      text += fmt::format("{} {:.4g}", parameter.symbol, *real);
    else
      text += fmt::format("{} {}", parameter.symbol, text_of(value));
  }
  return text;
}

std::string title(const Candidate& candidate) {
  const std::string parameters = describe(candidate);
  return fmt::format("{}{}{}", name(candidate.technique), parameters.empty() ? "" : ", ", parameters);
}

void check(const Candidate& candidate) {
  const TechniqueRecord& record = record_of(candidate.technique);
  if (!record.built)
    throw std::invalid_argument(fmt::format("{} needs Embree, without which this detp was built", record.name));
  if (candidate.parameters.index() != record.defaults.index())
    throw std::invalid_argument(fmt::format("the parameters are not those of {}", record.name));
  for (const Parameter& parameter : record.parameters) require_in_range(parameter, parameter.get(candidate.parameters));
}

std::vector<Candidate> small_variants(Technique technique) {
  const TechniqueRecord& record = record_of(technique);
  Candidate small = default_candidate(technique);
  for (const Parameter& parameter : record.parameters) parameter.set(small.parameters, parameter.small);
  std::vector<Candidate> variants{small};
  const auto add = [&](const Parameter& parameter, const ParameterValue& value) {
    Candidate variant = small;
    parameter.set(variant.parameters, value);
    if (std::find(variants.begin(), variants.end(), variant) == variants.end()) variants.push_back(variant);
  };
  for (const Parameter& parameter : record.parameters) {
    if (std::holds_alternative<std::int64_t>(parameter.small))
      add(parameter, static_cast<std::int64_t>(parameter.least));
    for (const std::string_view choice : parameter.choices) add(parameter, choice);
  }
  return variants;
}

}  // namespace detp
