#include "ask.hpp"

#include <stdexcept>

#include "command_line.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/validate/cli/options/command_files.hpp"
#include "envelope.hpp"

namespace detp::cli {

Json ask(const std::vector<std::string>& words, const std::stop_token& stop) {
  if (words.empty()) throw std::invalid_argument("a command is needed, as model");
  std::vector<std::string> all{"detp"};
  all.insert(all.end(), words.begin(), words.end());
  all.emplace_back("--quiet");
  std::vector<char*> arguments;
  for (std::string& word : all) arguments.push_back(word.data());
  CommandLine line;
  try {
    const Command& command = line.parse(static_cast<int>(arguments.size()), arguments.data());
    CommonOptions common = line.common();
    if (common.memory_limit) throw std::invalid_argument("--memory-limit is for the command alone");
    if (common.time_limit != 0)
      throw std::invalid_argument("--time-limit is for the command alone; stop the call instead");
    settle_format(*command.app, common);
    if (common.output && !writes_output(*command.app))
      throw std::invalid_argument("--output is for the command alone: the answer is returned");
    check_files(*command.app, common, stop);
    common.format = "json";  // some commands make nothing else then
    Result result = command.run(common, stop);
    result.json["stopped"] = result.stopped.has_value();
    return envelope(command.app->get_name(), common, sim::thread_count(common.threads), result);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0)
      throw std::invalid_argument("--help and --version are for the command alone; ask a question, as model");
    throw std::invalid_argument(line.message(error));
  }
}

}  // namespace detp::cli
