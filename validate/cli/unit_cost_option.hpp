#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "detp/model/vocabulary.hpp"

namespace detp::cli {

/// Reads "t=1e-9,u=2e-9": t sphere test, u disc test, w disc test in an index's cell alone, v step of a grid and node
/// of a tree, n node of a tree alone, c copy, b placement in an index, s sample sorted, r rebuild. What is not named
/// stays as in `otherwise`. Throws std::invalid_argument for anything else, and for a cost that is negative or not
/// finite.
[[nodiscard]] UnitCosts parse_unit_costs(const std::string& text, const UnitCosts& otherwise);

/// By the same names.
[[nodiscard]] nlohmann::ordered_json to_json(const UnitCosts& costs);

}  // namespace detp::cli
