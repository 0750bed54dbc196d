#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "common_options.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"

/// The unit costs of a command: given by the user, calibrated on this machine, or built in.
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

struct CostsInUse {
  CostTable simd;
  CostTable plain;
  std::string origin;  ///< "of each operation: built in, ..."
  bool built_in = false;
  double relative_error = 0;  ///< standard error of seconds by these costs, relative to them; 0: not known
  std::string doubt = {};     ///< why seconds by these costs are doubtful; mostly empty

  [[nodiscard]] const CostTable& of(Engine engine) const { return engine == Engine::plain ? plain : simd; }
};

/// Beside predicted seconds: a line on standard error if they are doubtful.
void note_doubt(const CostsInUse& costs, const CommonOptions& common);

class CostOptions {
 public:
  /// --costs and --calibration.
  void add_to(CLI::App& command);
  void add_calibration_to(CLI::App& command);

  /// --costs, which are of one thread; else the calibration that --calibration names; with auto the stored one, if there is one for this machine
  /// and program; else the costs of a probe, which is made once; else the built-in costs. Notes on standard error why a stored calibration
  /// is not used. Throws
  /// std::invalid_argument for wrong options and for a named calibration of another machine; sim::FileError for a named
  /// file that is no calibration.
  [[nodiscard]] CostsInUse costs(const CommonOptions& common) const;

 private:
  std::string costs_;
  std::string calibration_ = "auto";
};

}  // namespace detp::cli
