#include "neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace detp::validate {
namespace {

std::vector<ParameterValue> steps_from(const Parameter& parameter, const ParameterValue& value) {
  if (const auto* ratio = std::get_if<double>(&value)) return {(2 - parameter.step) * *ratio, parameter.step * *ratio};
  const auto number = std::get<std::int64_t>(value);
  if (parameter.step == 0) return {number - 1, number + 1};
  return {static_cast<std::int64_t>(std::llround(static_cast<double>(number) / parameter.step)),
          static_cast<std::int64_t>(std::llround(static_cast<double>(number) * parameter.step))};
}

/// Adds nothing if `value` is not in the parameter's range or not a change.
void add(std::vector<Candidate>& all, Candidate candidate, const Parameter& parameter, const ParameterValue& value) {
  const ParameterValue now = parameter.get(candidate.parameters);
  try {
    set_parameter(candidate, parameter.name, value);
  } catch (const std::invalid_argument&) {
    return;
  }
  if (parameter.get(candidate.parameters) != now) all.push_back(candidate);
}

}  // namespace

std::vector<Candidate> techniques_left_out(const std::vector<Candidate>& candidates) {
  std::vector<Candidate> left_out;
  for (const Technique technique : exact_techniques) {
    const bool there = std::any_of(candidates.begin(), candidates.end(),
                                   [&](const Candidate& candidate) { return candidate.technique == technique; });
    if (!there) left_out.push_back(default_candidate(technique));
  }
  return left_out;
}

std::vector<Candidate> neighbours(const Candidate& candidate) {
  std::vector<Candidate> all;
  const auto& parameters = record_of(candidate.technique).parameters;
  for (const Parameter& parameter : parameters) {
    const ParameterValue now = parameter.get(candidate.parameters);
    if (parameter.choices.empty()) {
      for (const ParameterValue& value : steps_from(parameter, now)) add(all, candidate, parameter, value);
    } else if (parameters.size() == 1) {  // the choice is the only parameter to vary
      for (const std::string_view choice : parameter.choices) add(all, candidate, parameter, choice);
    }
  }
  return all;
}

}  // namespace detp::validate
