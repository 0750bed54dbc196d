#include "candidate_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/lists/simd/instruction_sets.hpp"

namespace detp::cli {
namespace {

constexpr std::string_view spheres_option = "spheres";

std::vector<std::string_view> technique_names() {
  std::vector<std::string_view> names;
  for (const Technique technique : all_techniques) names.push_back(name(technique));
  return names;
}

std::string known_techniques() { return fmt::format("{}", fmt::join(technique_names(), ", ")); }

/// The option for a parameter that one or more techniques have. `help` has its meaning for each of these techniques.
struct SharedParameter {
  const Parameter* parameter;
  std::string help;
};

/// All parameters in the order of the techniques, one for each name.
std::vector<SharedParameter> shared_parameters() {
  std::vector<SharedParameter> all;
  for (const Technique technique : all_techniques)
    for (const Parameter& parameter : record_of(technique).parameters) {
      const auto same = std::find_if(all.begin(), all.end(),
                                     [&](const SharedParameter& one) { return one.parameter->name == parameter.name; });
      if (same == all.end())
        all.push_back({&parameter, std::string(parameter.help)});
      else if (same->help.find(parameter.help) == std::string::npos)
        same->help += fmt::format("; {}", parameter.help);
    }
  return all;
}

}  // namespace

void CandidateOptions::add_to(CLI::App& command, Values values, SphereStop default_stop) {
  const bool of_model = default_stop == SphereStop::max;  // else of `run`
  using enum ValueLists::Kind;
  lists.add(
      command, "--technique", values, words, [this](const std::string& text) { technique = text; },
      fmt::format("{}; default: {}", known_techniques(),
                  of_model ? name(Technique::sphere_cache)
                           : "chosen by a pilot; for short searches by the numbers of rays and discs; for streams of "
                             "rays and --engine plain by the closed forms"));
  for (const auto& [parameter, about] : shared_parameters()) {
    std::string help = about;
    if (!parameter->choices.empty()) help += fmt::format(": {}", fmt::join(parameter->choices, ", "));
    if (parameter->name != spheres_option)
      help +=
          of_model
              ? "; default: the paper's rule for sphere-cache, octree and grid, else the fastest by the closed forms"
              : "; default: chosen with the technique; with --technique the fastest by the closed forms";
    else
      help += fmt::format(", as a number; max: the form's own; best: the fastest by the closed forms; default: {}",
                          of_model ? "max" : "best");
    lists.add(
        command, fmt::format("--{}", parameter->name), values, parameter->choices.empty() ? numbers : words,
        [this, one = parameter](const std::string& text) { set(*one, text); }, help);
  }
  lists.add(
      command, "--engine", values, words, [this](const std::string& text) { engine = parse_engine(text); },
      engine_help);
}

Engine parse_engine(const std::string& text) {
  return *choice_named<Engine>(one_of("--engine", text, {"plain", "simd"}));
}

void CandidateOptions::set(const Parameter& parameter, const std::string& text) {
  const std::string option = fmt::format("--{}", parameter.name);
  given_.erase(parameter.name);
  if (parameter.name == spheres_option) {
    stop.reset();
    if (text == "max") stop = SphereStop::max;
    if (text == "best") stop = SphereStop::best;
    if (stop) return;
  }
  if (!parameter.choices.empty()) {
    const std::string word = one_of(option, text, {parameter.choices.begin(), parameter.choices.end()});
    given_[parameter.name] = *std::find(parameter.choices.begin(), parameter.choices.end(), word);
  } else if (std::holds_alternative<double>(parameter.small)) {
    given_[parameter.name] = parse_number(option, text);
  } else {
    given_[parameter.name] = parse_whole(option, text);
  }
}

Technique parse_technique(const std::string& text) {
  const auto found = technique_named(text);
  if (!found)
    throw std::invalid_argument(fmt::format("there is no technique {}; there are {}{}", detp::quoted(text),
                                            known_techniques(), did_you_mean(text, technique_names())));
  return *found;
}

sim::Estimator parse_estimator(const std::string& text) {
  std::vector<std::string_view> names;
  for (const sim::EstimatorRecord& one : sim::estimators) {
    if (text == one.name) return one.estimator;
    names.push_back(one.name);
  }
  throw std::invalid_argument(fmt::format("there is no estimator {}; there are {}{}", detp::quoted(text),
                                          fmt::join(names, ", "), did_you_mean(text, names)));
}

model::FixedParameters CandidateOptions::fixed_parameters(Technique chosen) const {
  const auto require_known = [&](std::string_view parameter) {
    if (find_parameter(chosen, parameter) == nullptr)
      throw std::invalid_argument(fmt::format("--{} is no parameter of {}", parameter, detp::name(chosen)));
  };
  model::FixedParameters fixed;
  for (const auto& [parameter, value] : given_) {
    require_known(parameter);
    fixed.values.emplace_back(parameter, value);
  }
  if (stop) require_known(spheres_option);
  return fixed;
}

void InstructionSetOption::add_to(CLI::App& command, const std::string& whose) {
  command
      .add_option("--instruction-set", sets_,
                  "instruction set of " + whose + ": AVX3 (AVX-512), AVX2, SSE4; default: the best of this machine")
      ->delimiter(',');
}

std::vector<std::string> InstructionSetOption::sets() const {
  if (sets_.empty()) return {""};
  for (const std::string& set : sets_) const sim::stream::OnlyInstructionSet here(set);
  return sets_;
}

std::string InstructionSetOption::only() const {
  const std::vector<std::string> all = sets();
  if (all.size() > 1) throw std::invalid_argument("--instruction-set takes only one here");
  return all.front();
}

}  // namespace detp::cli
