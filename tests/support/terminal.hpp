#pragma once

#include <pty.h>

#include <cstdlib>

#include "command.hpp"

/// Runs the command on a terminal of its own.
namespace detp::support {

using Environment = std::vector<std::pair<std::string, std::string>>;

/// The command's stdout and stderr as a terminal with `columns` columns receives them, with \r\n converted to \n.
inline std::string shown_on_terminal(const std::string& line, unsigned short columns = 120,
                                     const Environment& environment = {}) {
  std::vector<std::string> all{DETP_COMMAND};
  for (const std::string& word : words(line)) all.push_back(word);
  std::vector<char*> pointers;
  for (std::string& word : all) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const winsize size{.ws_row = 40, .ws_col = columns, .ws_xpixel = 0, .ws_ypixel = 0};
  int terminal = -1;
  const pid_t id = ::forkpty(&terminal, nullptr, nullptr, &size);
  if (id == 0) {
    ::unsetenv("NO_COLOR");
    ::setenv("TERM", "xterm", 1);
    for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
    ::execv(pointers[0], pointers.data());
    ::_exit(127);
  }
  if (id < 0) throw std::runtime_error("cannot open a terminal");
  std::string shown;
  char buffer[4096];
  for (ssize_t count = 0; (count = ::read(terminal, buffer, sizeof buffer)) > 0;)
    shown.append(buffer, static_cast<std::size_t>(count));
  ::close(terminal);
  int status = 0;
  ::waitpid(id, &status, 0);
  return std::regex_replace(shown, std::regex("\r\n"), "\n");
}

}  // namespace detp::support
