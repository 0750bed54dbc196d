#include "cost_options.hpp"

#include <fmt/format.h>

#include <algorithm>
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

void note_doubt(const validate::CostsInUse& costs, const CommonOptions& common) {
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

validate::CostRequest CostOptions::request(const CommonOptions& common) const {
  // On several processes, each probe might find other costs.
  return {.given = parse_unit_costs(costs_), .calibration = calibration_, .may_probe = common.ranks == nullptr};
}

CostsInUse CostOptions::costs(const CommonOptions& common) const {
  return validate::costs_in_use(request(common), [&](const std::string& notice) { note(common, notice); });
}

}  // namespace detp::cli
