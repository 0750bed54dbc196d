#pragma once

#include <CLI/CLI.hpp>
#include <stop_token>

#include "common_options.hpp"

/// The files that a command's options name.
namespace detp::cli {

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
