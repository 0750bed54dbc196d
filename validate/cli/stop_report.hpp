#pragma once

#include "command.hpp"
#include "detp/sim/base/stopped.hpp"

/// What a stop request leaves of an answer.
namespace detp::cli {

/// The result of a command that a stop request ended before there was any: how far it came, and the options it was
/// given.
[[nodiscard]] Result stopped_result(const CLI::App& command, const sim::Stopped& stopped);

/// Says in all formats that the result is partial, and how far the work came. `seconds`: from the stop request to now.
///
/// JSON: `stopped_after` {`done`, `of`, `unit`} and `stop_seconds`; text: a first line; CSV: the columns
/// `stopped_after`, `stopped_of` and `stopped_unit` in every row.
void mark_stopped(Result& result, double seconds);

}  // namespace detp::cli
