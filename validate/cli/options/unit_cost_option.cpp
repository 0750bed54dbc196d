#include "unit_cost_option.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/quoted.hpp"
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

std::string zero_costs(const UnitCosts& costs) {
  std::string list;
  for (const UnitCostTerm& one : unit_cost_terms)
    if (costs.*one.cost == 0) list += fmt::format("{}{}", list.empty() ? "" : ", ", one.symbol);
  return list;
}

}  // namespace detp::cli
