#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::cli {

/// The meaning of each name of --costs, one per line, for the help.
[[nodiscard]] std::string unit_cost_help();

/// Reads "t=1e-9,u=2e-9": names as in the help, in any order, each at most once; costs that are not named are 0. An
/// empty text returns `otherwise`. Throws std::invalid_argument for anything else, and for a cost that is negative or
/// not finite.
[[nodiscard]] UnitCosts parse_unit_costs(const std::string& text, const UnitCosts& otherwise);

/// The unit costs as JSON, under the names of --costs.
[[nodiscard]] nlohmann::ordered_json to_json(const UnitCosts& costs);

/// The names of the costs that are 0: "t, u".
[[nodiscard]] std::string zero_costs(const UnitCosts& costs);

}  // namespace detp::cli
