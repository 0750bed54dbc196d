#pragma once

#include <CLI/CLI.hpp>

#include "detp/sim/base/stopped.hpp"
#include "detp/validate/cli/options/common_options.hpp"
#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/cli/text/screen.hpp"

/// What the results of all commands have around them, and those that a stop request ended.
namespace detp::cli {

/// The JSON of a command's result: schema, inputs, the result, provenance. Takes the inputs from `result`.
[[nodiscard]] Json envelope(const std::string& command, const CommonOptions& common, int threads, Result& result);

/// The result of a command that was stopped before it had results: its progress and its options.
[[nodiscard]] Result stopped_result(const CLI::App& command, const sim::Stopped& stopped);

/// Marks the result as partial in all formats, with the progress of the work. `seconds` is the time since the stop
/// request.
///
/// JSON: `stopped_after` {`done`, `of`, `unit`} and `stop_seconds`; text: a first line; CSV: the columns
/// `stopped_after`, `stopped_of` and `stopped_unit` in every row.
void mark_stopped(Result& result, double seconds, const Screen& screen);

}  // namespace detp::cli
