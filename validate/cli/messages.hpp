#pragma once

#include <span>
#include <string>
#include <string_view>

#include "command.hpp"

/// Output to the standard streams except results, and its errors.
namespace detp::cli {

/// Turns a closed pipe and the file size limit into errors of the write; by default they would end the program. Also
/// prevents that a closed stdin, stdout or stderr becomes the first file that is opened. Must be called first.
void prepare_streams();

/// Writes to stdout. Throws sim::FileError with the system's reason.
void write_result(const std::string& text);

/// Throws sim::FileError if std::cout could not be written.
void check_written();

/// Writes to stderr. Ignores errors, because they cannot be reported.
void write_error(std::string_view text);

/// Writes the message to stderr as one line of at most 500 characters, made safe to show. Returns the code.
int fail(ExitCode code, std::string message);

/// The message, with each argument or part of an argument that it repeats made safe to show and truncated after 60
/// characters.
[[nodiscard]] std::string with_short_arguments(std::string message, std::span<char* const> arguments);

}  // namespace detp::cli
