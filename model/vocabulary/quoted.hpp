#pragma once

#include <string>
#include <string_view>

/// Makes text from outside (a file, an option, a file's name) safe to show in a message.
namespace detp {

/// Maximum number of characters of one quoted piece of input.
inline constexpr std::size_t longest_quote = 60;

/// The text with everything escaped that could change how a terminal shows the rest: control characters (C0, DEL, C1),
/// bytes that are not valid UTF-8, line separators and marks of writing direction, each byte as \x1b. Nothing else
/// changes, so escaping twice equals escaping once.
[[nodiscard]] std::string escaped(std::string_view text);

/// Escaped and truncated after `most` characters; "..." shows the truncation.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t most = longest_quote);

/// The text escaped, truncated after `longest_quote` characters, and in double quotes.
[[nodiscard]] std::string quoted(std::string_view text);

/// The name of a file: escaped; in full up to 200 characters, else its first and last characters.
[[nodiscard]] std::string shown_path(std::string_view path);

}  // namespace detp
