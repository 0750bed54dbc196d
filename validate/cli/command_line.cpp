#include "command_line.hpp"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <stdexcept>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/threads.hpp"
#include "number_option.hpp"

namespace detp::cli {
namespace {

/// Up to 2⁶⁴ - 1, which a double cannot represent.
std::uint64_t parse_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc{} || end != text.data() + text.size())
    throw std::invalid_argument(fmt::format("--seed must be a whole number from 0 to {} (got {})",
                                            std::numeric_limits<std::uint64_t>::max(), detp::quoted(text)));
  return seed;
}

void add_common_options(CLI::App& command, CommonOptions& common) {
  command.add_option("--format", common.format, "text, json or csv")->check(CLI::IsMember({"text", "json", "csv"}));
  command.add_option("-o,--output", common.output, "write the result to a file instead of stdout");
  command.add_flag("--quiet", common.quiet, "no notices, no progress");
  command
      .add_option_function<std::string>(
          "--seed", [&common](const std::string& text) { common.seed = parse_seed(text); }, "of everything random")
      ->type_name("N");
  command
      .add_option_function<std::string>(
          "--threads",
          [&common](const std::string& text) {
            common.threads = static_cast<int>(parse_whole("--threads", text, 0, sim::most_threads));
          },
          "default: all cores")
      ->type_name("N");
  command.add_option("--memory-limit", common.memory_limit,
                     "refuse work that would take more, as 4G; default: half of the memory that detp may have");
  add_number(command, "--time-limit", common.time_limit, "stop after that many seconds and show what there is");
}

}  // namespace

CommandLine::CommandLine()
    : program_("Predicts, runs and checks techniques that find which rays cross which discs.", "detp"),
      commands_{model_command(program_),    choose_command(program_), run_command(program_),
                validate_command(program_), scene_command(program_),  bench_command(program_)} {
  program_.set_version_flag("--version", "detp " DETP_VERSION);
  program_.require_subcommand(0, 1);  // with 1 needed, an unknown command would be reported as a missing one
  for (const Command& command : commands_) add_common_options(*command.app, common_);
}

const Command& CommandLine::parse(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (*argv[i] == '\0')  // the parser would treat an empty value as absent, for instance --rays "$n" if n is not set
      throw std::invalid_argument(fmt::format("argument {} is empty, after {}; give it a value", i, argv[i - 1]));
  program_.parse(argc, argv);
  for (const Command& command : commands_)
    if (command.app->parsed()) return command;
  throw std::invalid_argument(
      "a command is needed: model, choose, run, validate, scene or bench (detp --help tells more)");
}

}  // namespace detp::cli
