#pragma once

#include <memory>
#include <optional>
#include <string>

#include "detp/sim/base/stopped.hpp"
#include "detp/validate/base/json.hpp"

namespace detp::validate {
struct JobAndRun;
}  // namespace detp::validate

/// The form of a command's result.
namespace detp::cli {

using validate::Json;

enum class ExitCode { done = 0, refuted = 1, bad_input = 2, stopped = 3, internal = 4 };

/// A command's result in the three formats. run_program() adds the JSON envelope (schema, provenance), and marks the
/// result of a stopped command.
struct Result {
  Json inputs;
  Json json;
  std::string text;
  std::string csv;
  ExitCode code = ExitCode::done;
  std::string schema = {};         ///< in JSON, after "detp."; empty: the command's name
  bool output_is_written = false;  ///< the command itself wrote the file of --output; the result goes to stdout
  bool not_reached = false;        ///< the result is complete, and says that the target is out of reach: exit code 3
  bool answers_at_limit = false;   ///< the result is complete even if the time limit ended the work
  std::shared_ptr<const validate::JobAndRun> run = {};  ///< of `run`, one row, if CommonOptions::in_memory
  /// the progress if a stop request ended the command, so that the result is partial; else nothing
  std::optional<sim::Progress> stopped = {};
};

}  // namespace detp::cli
