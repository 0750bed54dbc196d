#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "common_options.hpp"
#include "detp/validate/calibration/calibration_file.hpp"

/// --costs and --calibration: the unit costs of a command.
namespace detp::cli {

using validate::CostsInUse;
using validate::to_json;

/// The meaning of each name of --costs, one per line, for the help.
[[nodiscard]] std::string unit_cost_help();

/// Reads "t=1e-9,u=2e-9": names as in the help, in any order, each at most once; costs that are not named are 0.
/// Returns nothing for an empty text. Throws std::invalid_argument for anything else, and for a cost that is negative
/// or not finite.
[[nodiscard]] std::optional<UnitCosts> parse_unit_costs(const std::string& text);

/// Beside predicted seconds: a line on standard error if they are doubtful.
void note_doubt(const CostsInUse& costs, const CommonOptions& common);

class CostOptions {
 public:
  /// --costs and --calibration.
  void add_to(CLI::App& command);
  void add_calibration_to(CLI::App& command);

  /// Throws std::invalid_argument for wrong options.
  [[nodiscard]] validate::CostRequest request(const CommonOptions& common) const;
  /// Those of the request (validate::costs_in_use); notes on standard error why a stored calibration is not used.
  [[nodiscard]] CostsInUse costs(const CommonOptions& common) const;

 private:
  std::string costs_;
  std::string calibration_ = "auto";
};

}  // namespace detp::cli
