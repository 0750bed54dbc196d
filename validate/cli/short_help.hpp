#pragma once

#include <string_view>

namespace detp::cli {

/// What `detp COMMAND --help` shows: the options that matter, in groups, at most 40 lines of 80 columns. `--help all` has
/// all of them. Empty for an unknown command.
[[nodiscard]] std::string_view short_help(std::string_view command);

}  // namespace detp::cli
