#pragma once

#include <string>
#include <string_view>

namespace detp::cli {

/// The word as a POSIX shell takes it: as it is, or in single quotes if a character of it could mean something else.
[[nodiscard]] std::string shell_word(std::string_view word);

}  // namespace detp::cli
