#include "unit_cost_option.hpp"

#include <fmt/format.h>

#include <charconv>
#include <sstream>
#include <stdexcept>

namespace detp::cli {
namespace {

double& cost_named(UnitCosts& costs, std::string_view name) {
  if (name == "t") return costs.sphere_test;
  if (name == "u") return costs.disc_test;
  if (name == "w") return costs.index_test;
  if (name == "v") return costs.step;
  if (name == "n") return costs.node;
  if (name == "c") return costs.copy;
  if (name == "b") return costs.placement;
  if (name == "s") return costs.sort;
  if (name == "r") return costs.rebuild;
  throw std::invalid_argument(fmt::format("there is no unit cost '{}'; there are t, u, w, v, n, c, b, s, r", name));
}

double parse_cost(std::string_view name, std::string_view digits) {
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size())
    throw std::invalid_argument(fmt::format("unit cost {} must be a number (got '{}')", name, digits));
  require_non_negative(fmt::format("unit cost {}", name), value);
  return value;
}

}  // namespace

UnitCosts parse_unit_costs(const std::string& text, const UnitCosts& otherwise) {
  UnitCosts costs = otherwise;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos)
      throw std::invalid_argument(fmt::format("--costs takes name=value pairs, as t=1,u=2 (got '{}')", part));
    const std::string_view name = std::string_view(part).substr(0, equals);
    cost_named(costs, name) = parse_cost(name, std::string_view(part).substr(equals + 1));
    if (name == "u") costs.index_test = costs.disc_test;
    if (name == "v") costs.node = costs.step;
  }
  return costs;
}

nlohmann::ordered_json to_json(const UnitCosts& costs) {
  nlohmann::ordered_json json;
  UnitCosts copy = costs;
  for (const char* name : {"t", "u", "w", "v", "n", "c", "b", "s", "r"}) json[name] = cost_named(copy, name);
  return json;
}

}  // namespace detp::cli
