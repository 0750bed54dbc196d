#pragma once

#include <optional>
#include <vector>

#include "detp/validate/cli/options/common_options.hpp"
#include "detp/validate/cli/options/costs_in_use.hpp"
#include "detp/validate/cli/options/workload_options.hpp"
#include "detp/validate/cli/text/result.hpp"

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

}  // namespace detp::cli
