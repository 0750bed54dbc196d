#pragma once

#include <span>
#include <stop_token>
#include <string>
#include <string_view>

#include "result.hpp"

/// Output to the standard streams, and its errors.
namespace detp::cli {

/// Makes writes to a closed pipe, or beyond the file size limit, return errors instead of ending the program. If stdin,
/// stdout or stderr is closed, reserves its number, so that no opened file gets it. Must be called before any file is
/// opened.
void prepare_streams();

/// Writes to stdout. If this fails, throws sim::FileError with the system's reason; sim::Stopped as sim::OutputFile does.
void write_result(const std::string& text, const std::stop_token& stop = {});

/// Throws sim::FileError if std::cout could not be written.
void check_written();

/// Writes to stderr. Ignores errors, because they cannot be reported.
void write_error(std::string_view text);

/// While it exists, what is written to stdout and stderr is lost.
class Muted {
 public:
  Muted();
  ~Muted();
  Muted(const Muted&) = delete;
  Muted& operator=(const Muted&) = delete;

 private:
  int out_;  ///< descriptors of the real streams
  int error_;
};

/// Writes the message to stderr as one line of at most 500 characters, made safe to show. Returns the code.
int fail(ExitCode code, std::string message);

/// The message. Every argument, or part of an argument, that it quotes is made safe to show and truncated after 60
/// characters.
[[nodiscard]] std::string with_short_arguments(std::string message, std::span<char* const> arguments);

}  // namespace detp::cli
