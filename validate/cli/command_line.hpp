#pragma once

#include <array>
#include <string_view>

#include "command.hpp"

namespace detp::cli {

enum class HelpKind { brief, all, fields };

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
  HelpKind* help_ = nullptr;  ///< of the formatter
};

/// What `detp COMMAND --help` shows: the options that matter, in groups, at most 40 lines of 80 columns. `--help all` has
/// all of them, `--help fields` the fields of the answer. Empty for an unknown command.
[[nodiscard]] std::string_view short_help(std::string_view command);

/// The JSON that `detp WORDS… --format json` prints. Only files that the words name are written; nothing is printed. Throws
/// std::invalid_argument for bad usage, for help and for --memory-limit, which is the program's; as the commands do; sim::Stopped if a stop
/// request came before there was anything.
[[nodiscard]] Json ask(const std::vector<std::string>& words, const std::stop_token& stop);

struct AskedRun {
  Json json;
  std::shared_ptr<const validate::JobAndRun> run;
};

/// What `detp run WORDS…` does, with what it found. Throws as `ask`, and std::invalid_argument for several rows.
[[nodiscard]] AskedRun ask_run(std::vector<std::string> words, const std::stop_token& stop);

}  // namespace detp::cli
