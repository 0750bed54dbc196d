#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "common_options.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"

/// The unit costs of a command: given by the user, calibrated on this machine, or built in.
namespace detp::cli {

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
