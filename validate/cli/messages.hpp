#pragma once

#include <span>
#include <string>
#include <string_view>

#include "command.hpp"

/// What goes to the standard streams besides results, and what may go wrong with them.
namespace detp::cli {

/// Makes a closed pipe and a limit of file size errors of the write, instead of the end of the program; and keeps a
/// closed stdin, stdout or stderr from becoming the first file that is opened. To be called first.
void prepare_streams();

/// The text of a result, which may hold names of files, without control characters except ends of lines.
[[nodiscard]] std::string safe_text(std::string_view text);

/// Writes to stdout. Throws sim::FileError with the system's reason.
void write_result(const std::string& text);

/// Throws likewise where what std::cout was given could not be written.
void check_written();

/// Writes to stderr; where that fails, there is nobody to tell.
void write_error(std::string_view text);

/// Writes the message as one line to stderr, whatever is in it, and at most 500 characters of it; returns the code.
int fail(ExitCode code, std::string message);

/// The message with each argument that it repeats, or each part of one, made safe to show and cut after 60 characters.
[[nodiscard]] std::string with_short_arguments(std::string message, std::span<char* const> arguments);

}  // namespace detp::cli
