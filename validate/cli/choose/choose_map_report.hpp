#pragma once

#include <string>

#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/cli/text/screen.hpp"
#include "detp/validate/map/technique_map.hpp"

namespace detp::cli {

/// `axes`, `cells` and the seconds that it took; `agreement` if a cell was measured.
[[nodiscard]] Json to_json(const validate::TechniqueMap& map);

/// Maps of characters, side by side as far as they fit the screen, and how predicted and measured techniques agree. `verbose`: also
/// the map of the paper's rule, the cells that disagree, and how long it took.
[[nodiscard]] std::string to_text(const validate::TechniqueMap& map, const Screen& screen, bool verbose);

/// A row for each cell. The columns that are the same for all cells come from the resolved inputs.
[[nodiscard]] std::string to_csv(const validate::TechniqueMap& map, const Json& inputs);

}  // namespace detp::cli
