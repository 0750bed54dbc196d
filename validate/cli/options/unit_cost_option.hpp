#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::cli {

/// The meaning of each name of --costs, one per line, for the help.
[[nodiscard]] std::string unit_cost_help();

/// Reads "t=1e-9,u=2e-9": names as in the help, in any order, each at most once; costs that are not named are 0.
/// Returns nothing for an empty text. Throws std::invalid_argument for anything else, and for a cost that is negative
/// or not finite.
[[nodiscard]] std::optional<UnitCosts> parse_unit_costs(const std::string& text);

/// The unit costs as JSON, under the names of --costs.
[[nodiscard]] nlohmann::ordered_json to_json(const UnitCosts& costs);

/// The same for each exact technique, under its name; without names if all techniques have the same costs. Costs of 0
/// are left out.
[[nodiscard]] nlohmann::ordered_json to_json(const CostTable& costs);

/// The names of the costs that are 0: "t, u".
[[nodiscard]] std::string zero_costs(const UnitCosts& costs);

}  // namespace detp::cli
