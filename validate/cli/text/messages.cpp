#include "messages.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/files/file_error.hpp"
#include "detp/sim/files/output_file.hpp"

namespace detp::cli {
namespace {

constexpr std::size_t longest_message = 500;

[[noreturn]] void throw_write_error() {
  throw sim::FileError("standard output", std::string("cannot be written: ") + std::strerror(errno));
}

void shorten(std::string& message, std::string_view piece) {
  const std::string shown = shortened(piece);
  if (shown == piece || piece.empty()) return;
  for (std::size_t at = 0; (at = message.find(piece, at)) != std::string::npos; at += shown.size())
    message.replace(at, piece.size(), shown);
}

}  // namespace

void prepare_streams() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  // open() returns the lowest free number, which is that of the closed stream. It opens the file for the wrong
  // direction on purpose, so that reading stdin, or writing to stdout or stderr, still fails.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0) (void)::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

void write_result(const std::string& text, const std::stop_token& stop) {
  sim::OutputFile file("/dev/stdout", stop);
  file.write(text);
  file.commit();
}

void check_written() {
  errno = EIO;  // for a stream that does not report a reason
  if (!std::cout.flush() || std::fflush(stdout) != 0) throw_write_error();
}

void write_error(std::string_view text) {
  (void)std::fwrite(text.data(), 1, text.size(), stderr);
  (void)std::fflush(stderr);
}

Muted::Muted() : out_(::dup(STDOUT_FILENO)), error_(::dup(STDERR_FILENO)) {
  const int nowhere = ::open("/dev/null", O_WRONLY);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  ::close(nowhere);
}

Muted::~Muted() {
  (void)std::fflush(stdout);
  ::dup2(out_, STDOUT_FILENO);
  ::dup2(error_, STDERR_FILENO);
  ::close(out_);
  ::close(error_);
}

int fail(ExitCode code, std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  write_error("detp: " + shortened(message, longest_message) + "\n");
  return static_cast<int>(code);
}

std::string with_short_arguments(std::string message, std::span<char* const> arguments) {
  for (const std::string_view argument : arguments) {
    shorten(message, argument);
    for (std::string_view rest = argument; !rest.empty();) {
      const std::size_t end = std::min(rest.find_first_of("=,:"), rest.size());
      shorten(message, rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
      shorten(message, rest);
    }
  }
  return message;
}

}  // namespace detp::cli
