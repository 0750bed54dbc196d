#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "detp/validate/cli/text/result.hpp"

namespace detp::cli {

/// The JSON that `detp WORDS… --format json` prints. Only files that the words name are written; nothing is printed. Throws
/// std::invalid_argument for bad usage, for help and for --memory-limit, which is the program's; as the commands do; sim::Stopped if a stop
/// request came before there was anything.
[[nodiscard]] Json ask(const std::vector<std::string>& words, const std::stop_token& stop);

}  // namespace detp::cli
