#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>

#include "detp/sim/ranks/ranks.hpp"
#include "detp/validate/cli/text/screen.hpp"

/// The options of every command, and the files that its options name.
namespace detp::cli {

/// The options of every command.
struct CommonOptions {
  std::string format = "text";
  Colour colour = Colour::automatic;
  std::optional<std::string> output;
  bool quiet = false;
  std::uint64_t seed = 1;
  int threads = 0;        ///< 0: all cores
  double time_limit = 0;  ///< seconds; 0: none
  std::optional<std::string> memory_limit;
  bool in_memory = false;       ///< the caller takes the result of a run from memory, too
  sim::Ranks* ranks = nullptr;  ///< the processes that run this command together; null: this one alone

  [[nodiscard]] Screen screen() const;
  /// This process is the one that answers: it prints, and writes files.
  [[nodiscard]] bool answers() const { return ranks == nullptr || ranks->rank() == 0; }
};

/// Writes a line to stderr, unless --quiet is set. A message that begins with "warning: " is coloured.
void note(const CommonOptions& common, const std::string& message);

/// Sets the format of the answer by the suffix of --output, unless --format is given. Throws std::invalid_argument for a suffix
/// that the command does not write, and if suffix and --format contradict each other.
void settle_format(const CLI::App& command, CommonOptions& common);

/// The command writes --output itself; else that is a file for the answer.
[[nodiscard]] bool writes_output(const CLI::App& command);

/// To be called before any work. Throws sim::FileError if an output cannot be written. Throws std::invalid_argument
/// - if the suffix of an output is not that of a format which it can have,
/// - if two outputs are one file, or an output is one of the command's inputs, by whatever path: also the materials that a mesh
///   names and the stored calibration,
/// - for --resume without --checkpoint.
/// Throws sim::FileError too if --checkpoint without --resume names a file that is no checkpoint.
/// Throws sim::Stopped on a stop request.
void check_files(const CLI::App& command, const CommonOptions& common, const std::stop_token& stop);

}  // namespace detp::cli
