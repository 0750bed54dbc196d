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

struct Name {
  std::string_view name;
  double UnitCosts::*cost;
  std::string_view meaning;
};

constexpr std::array names{
    Name{"t", &UnitCosts::sphere_test, "a ray of a list tested against a sphere or a box"},
    Name{"u", &UnitCosts::disc_test, "a ray of a list tested against a disc"},
    Name{"w", &UnitCosts::index_test, "a ray tested against a disc of the cell that it is in (octree, grid)"},
    Name{"v", &UnitCosts::step, "a ray's step to a cell of a grid"},
    Name{"n", &UnitCosts::node, "a ray's visit to a node of an octree"},
    Name{"c", &UnitCosts::copy, "a ray copied into a list"},
    Name{"b", &UnitCosts::placement, "a disc placed in a cell or node while an index is built"},
    Name{"s", &UnitCosts::sort, "a sample sorted along the curve"},
    Name{"r", &UnitCosts::rebuild, "a sphere rebuilt, beside its tests and copies"},
};

const Name& named(std::string_view name) {
  const auto found = std::find_if(names.begin(), names.end(), [&](const Name& one) { return one.name == name; });
  if (found != names.end()) return *found;
  throw std::invalid_argument(
      fmt::format("there is no unit cost {}; there are t, u, w, v, n, c, b, s, r", detp::quoted(name)));
}

constexpr UnitCosts nothing{.sphere_test = 0, .disc_test = 0, .index_test = 0, .step = 0, .node = 0};

}  // namespace

std::string unit_cost_help() {
  std::string help = "unit costs in seconds as name=value,... in any order; what is not named is 0:";
  for (const Name& one : names) help += fmt::format("\n  {}  {}", one.name, one.meaning);
  return help;
}

UnitCosts parse_unit_costs(const std::string& text, const UnitCosts& otherwise) {
  if (text.empty()) return otherwise;
  UnitCosts costs = nothing;
  std::vector<std::string_view> given;
  for (const std::string& part : words_of(text)) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos)
      throw std::invalid_argument(
          fmt::format("--costs takes name=value pairs, as t=1,u=2 (got {})", detp::quoted(part)));
    const Name& one = named(std::string_view(part).substr(0, equals));
    if (std::find(given.begin(), given.end(), one.name) != given.end())
      throw std::invalid_argument(fmt::format("unit cost {} is given twice in --costs; give it once", one.name));
    given.push_back(one.name);
    const std::string what = fmt::format("unit cost {}", one.name);
    costs.*one.cost = parse_number(what, std::string_view(part).substr(equals + 1));
    require_non_negative(what, costs.*one.cost);
  }
  return costs;
}

nlohmann::ordered_json to_json(const UnitCosts& costs) {
  nlohmann::ordered_json json;
  for (const Name& one : names) json[std::string(one.name)] = costs.*one.cost;
  return json;
}

std::string free_of_charge(const UnitCosts& costs) {
  std::string list;
  for (const Name& one : names)
    if (costs.*one.cost == 0) list += fmt::format("{}{}", list.empty() ? "" : ", ", one.name);
  return list;
}

}  // namespace detp::cli
