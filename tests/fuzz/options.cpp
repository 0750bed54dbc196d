// The command line: arguments, one a line, are parsed or refused. No command is run.

#include <stdexcept>
#include <vector>

#include "detp/validate/cli/command_line.hpp"
#include "detp/validate/cli/options/cost_options.hpp"
#include "scratch.hpp"

namespace {

std::vector<std::string> arguments_of(std::string_view text) {
  std::vector<std::string> arguments{"detp"};
  for (;;) {
    const std::size_t end = text.find('\n');
    arguments.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) return arguments;
    text.remove_prefix(end + 1);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = detp::fuzz::text_of(data, size);
  std::vector<std::string> arguments = arguments_of(text);
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  try {
    detp::cli::CommandLine line;
    (void)line.parse(static_cast<int>(pointers.size()), pointers.data());
  } catch (const CLI::ParseError&) {
  } catch (const std::invalid_argument&) {
  }
  try {
    (void)detp::cli::parse_unit_costs(std::string(text));
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
