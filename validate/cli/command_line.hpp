#pragma once

#include <array>

#include "command.hpp"

namespace detp::cli {

/// The parser of the command line. Parsing only sets the options.
class CommandLine {
 public:
  CommandLine();
  CommandLine(const CommandLine&) = delete;  // the parsers point into this object
  CommandLine& operator=(const CommandLine&) = delete;

  /// Sets the options and returns the command that the arguments name. Throws CLI::ParseError for bad usage, and if
  /// help or the version is requested. Throws std::invalid_argument for an empty argument, and if no command is named.
  [[nodiscard]] const Command& parse(int argc, char** argv);

  /// All commands, a line each, and an example: what detp prints without arguments.
  [[nodiscard]] std::string overview() const;

  [[nodiscard]] const CommonOptions& common() const { return common_; }

  /// The error message. For an unknown option, the message suggests the option that is probably meant.
  [[nodiscard]] std::string message(const CLI::ParseError& error) const;

  /// Prints the help or the version that the error represents, and returns 0. For other errors returns their exit code,
  /// which is not 0.
  int exit(const CLI::ParseError& error) const { return program_.exit(error); }

 private:
  [[nodiscard]] std::string names() const;
  /// Throws std::invalid_argument if `name` is not a command.
  void require_command(const std::string& name) const;

  CLI::App program_;
  CommonOptions common_;
  std::array<Command, 9> commands_;
  bool* all_options_ = nullptr;  ///< of the formatter: the help is to have every option
};

}  // namespace detp::cli
