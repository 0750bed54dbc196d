#pragma once

#include <optional>
#include <string>
#include <vector>

#include "detp/validate/cli/options/common_options.hpp"
#include "detp/validate/cli/options/cost_options.hpp"
#include "detp/validate/cli/options/workload_options.hpp"
#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/cli/text/screen.hpp"
#include "detp/validate/map/technique_map.hpp"

/// `choose --map`.
namespace detp::cli {

struct ChooseMap {
  WorkloadOptions& workload;
  const CostOptions& costs;
  std::optional<Rigor> rigor;
  std::vector<Technique> disabled;
  Engine engine = Engine::simd;
  bool analyze = false;
  bool verbose = false;
  std::optional<std::string> checkpoint = {};
  bool resume = false;
};

/// The map over the values of --rays and --disc-radius, or over those of default_map_rays and default_map_radii. If
/// --output names a file *.svg, writes the picture there, and the result goes to stdout. Throws as make_map.
[[nodiscard]] Result run_choose_map(const ChooseMap& command, const CommonOptions& common, const std::stop_token& stop);

/// `axes`, `cells` and the seconds that it took; `agreement` if a cell was measured.
[[nodiscard]] Json to_json(const validate::TechniqueMap& map);

/// Maps of characters, side by side as far as they fit the screen, and how predicted and measured techniques agree. `verbose`: also
/// the map of the paper's rule, the cells that disagree, and how long it took.
[[nodiscard]] std::string to_text(const validate::TechniqueMap& map, const Screen& screen, bool verbose);

/// A row for each cell. The columns that are the same for all cells come from the resolved inputs.
[[nodiscard]] std::string to_csv(const validate::TechniqueMap& map, const Json& inputs);

}  // namespace detp::cli
