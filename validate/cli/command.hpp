#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <stop_token>
#include <string>

#include "detp/sim/base/progress.hpp"
#include "screen.hpp"

/// The options of every command, and the form of their results.
namespace detp::cli {

using Json = nlohmann::ordered_json;

enum class ExitCode { done = 0, refuted = 1, bad_input = 2, stopped = 3, internal = 4 };

struct CommonOptions {
  std::string format = "text";
  Colour colour = Colour::automatic;
  std::optional<std::string> output;
  bool quiet = false;
  std::uint64_t seed = 1;
  int threads = 0;        ///< 0: all cores
  double time_limit = 0;  ///< seconds; 0: none
  std::optional<std::string> memory_limit;

  [[nodiscard]] Screen screen() const;
};

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
  /// the progress if a stop request ended the command, so that the result is partial; else nothing
  std::optional<sim::Progress> stopped = {};
};

/// One command: its parser, and the function that runs it after the options have been parsed.
struct Command {
  CLI::App* app;
  std::function<Result(const CommonOptions&, std::stop_token)> run;
};

[[nodiscard]] Command model_command(CLI::App& program);
[[nodiscard]] Command choose_command(CLI::App& program);
[[nodiscard]] Command run_command(CLI::App& program);
[[nodiscard]] Command validate_command(CLI::App& program);
[[nodiscard]] Command scene_command(CLI::App& program);
[[nodiscard]] Command bench_command(CLI::App& program);
[[nodiscard]] Command calibrate_command(CLI::App& program);
[[nodiscard]] Command accuracy_command(CLI::App& program);

void note(const CommonOptions& common, const std::string& message);

}  // namespace detp::cli
