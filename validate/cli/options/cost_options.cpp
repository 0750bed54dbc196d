#include "cost_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "detp/validate/calibration/probe.hpp"
#include "value_lists.hpp"

namespace detp::cli {
namespace {

std::string symbols() {
  std::string list;
  for (const UnitCostTerm& one : unit_cost_terms) list += fmt::format("{}{}", list.empty() ? "" : ", ", one.symbol);
  return list;
}

const UnitCostTerm& named(std::string_view name) {
  for (const UnitCostTerm& one : unit_cost_terms)
    if (one.symbol == name) return one;
  throw std::invalid_argument(fmt::format("there is no unit cost {}; there are {}", detp::quoted(name), symbols()));
}

CostsInUse built_in() {
  return {
      .simd = validate::built_in_unit_costs(Engine::simd),
      .plain = validate::built_in_unit_costs(Engine::plain),
      .origin = "of each operation: built in, measured on another machine; detp calibrate measures those of this one",
      .built_in = true};
}

CostsInUse calibrated(const validate::StoredCalibration& stored) {
  return {.simd = stored.simd,
          .plain = stored.plain,
          .origin = stored.probe
                        ? "of each operation: built in, scaled by a probe of this machine; detp calibrate knows more"
                        : fmt::format("of each operation: of this machine, calibrated {} (median error {:.2g} %)",
                                      stored.date, 100 * stored.left_out_median_error),
          .relative_error = stored.relative_error(),
          .doubt = stored.doubt()};
}

/// The stored calibration, unless it is missing, broken or of another machine.
CostsInUse stored_or_built_in(const CommonOptions& common) {
  if (common.ranks == nullptr) validate::probe_once();  // on several processes, each might find other costs
  std::string why_not;
  const auto stored = validate::stored_calibration(&why_not);
  if (!why_not.empty()) note(common, fmt::format("{}; not used; detp calibrate makes a new one", why_not));
  return stored ? calibrated(*stored) : built_in();
}

}  // namespace

std::string unit_cost_help() {
  std::string help = "unit costs in seconds as name=value,... in any order; what is not named is 0:";
  for (const UnitCostTerm& one : unit_cost_terms) help += fmt::format("\n  {}  {}", one.symbol, one.meaning);
  return help;
}

std::optional<UnitCosts> parse_unit_costs(const std::string& text) {
  if (text.empty()) return std::nullopt;
  UnitCosts costs;
  for (const UnitCostTerm& one : unit_cost_terms) costs.*one.cost = 0;
  std::vector<std::string_view> given;
  for (const std::string& part : words_of(text)) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos)
      throw std::invalid_argument(
          fmt::format("--costs takes name=value pairs, as t=1,u=2 (got {})", detp::quoted(part)));
    const UnitCostTerm& one = named(std::string_view(part).substr(0, equals));
    if (std::find(given.begin(), given.end(), one.symbol) != given.end())
      throw std::invalid_argument(fmt::format("unit cost {} is given twice in --costs; give it once", one.symbol));
    given.push_back(one.symbol);
    const std::string what = fmt::format("unit cost {}", one.symbol);
    costs.*one.cost = parse_number(what, std::string_view(part).substr(equals + 1));
    require_non_negative(what, costs.*one.cost);
  }
  return costs;
}

nlohmann::ordered_json to_json(const UnitCosts& costs) {
  nlohmann::ordered_json json;
  for (const UnitCostTerm& one : unit_cost_terms) json[std::string(one.symbol)] = costs.*one.cost;
  return json;
}

nlohmann::ordered_json to_json(const CostTable& costs) {
  if (costs.of_technique == CostTable(costs.of_technique.front()).of_technique)
    return to_json(costs.of_technique.front());
  nlohmann::ordered_json json;
  for (const Technique technique : exact_techniques) {
    nlohmann::ordered_json& of_one = json[std::string(name(technique))] = nlohmann::ordered_json::object();
    for (const UnitCostTerm& one : unit_cost_terms)
      if (const double cost = costs[technique].*one.cost; cost > 0) of_one[std::string(one.symbol)] = cost;
  }
  return json;
}

void note_doubt(const CostsInUse& costs, const CommonOptions& common) {
  if (costs.doubt.empty()) return;
  note(common,
       fmt::format(
           "predicted seconds are doubtful, as is the calibration: {}; calibrate again while the machine is quiet",
           costs.doubt));
}

void CostOptions::add_to(CLI::App& command) {
  command.add_option("--costs", costs_, unit_cost_help() + "\ndefault: those of --calibration");
  add_calibration_to(command);
}

void CostOptions::add_calibration_to(CLI::App& command) {
  command.add_option(
      "--calibration", calibration_,
      "unit costs: none (the built-in ones), auto (those that detp calibrate stored, else by a probe of 0.2 s, kept "
      "like them) or a file that it wrote; default: auto");
}

CostsInUse CostOptions::costs(const CommonOptions& common) const {
  if (const auto given = parse_unit_costs(costs_)) {
    CostsInUse as_given{.simd = *given, .plain = *given, .origin = "of each operation, as given, on one thread"};
    as_given.plain.engine = Engine::plain;
    return as_given;
  }
  if (calibration_ == "none") return built_in();
  if (calibration_ == "auto") return stored_or_built_in(common);
  const validate::StoredCalibration stored = validate::read_calibration(calibration_);
  const std::string differs = validate::difference(stored.key, validate::this_machine());
  if (!differs.empty())
    throw std::invalid_argument(fmt::format(
        "{} is of another machine or program: {}; make one here with detp calibrate", calibration_, differs));
  return calibrated(stored);
}

}  // namespace detp::cli
