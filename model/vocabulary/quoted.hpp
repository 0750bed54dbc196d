#pragma once

#include <string>
#include <string_view>

/// Text that came from outside (a file, an option, a file's name), made safe to stand in a message.
namespace detp {

/// Most characters of one quoted piece of input.
inline constexpr std::size_t longest_quote = 60;

/// The text with everything escaped that could change how a terminal shows the rest: control characters (C0, DEL, C1),
/// bytes that are no UTF-8, line separators and marks of writing direction, each byte as \x1b. Nothing else changes, so
/// that escaping twice is the same as once.
[[nodiscard]] std::string escaped(std::string_view text);

/// Escaped and cut after `most` characters; "..." shows that it was cut.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t most = longest_quote);

/// Likewise, in double quotes.
[[nodiscard]] std::string quoted(std::string_view text);

/// The name of a file: escaped, whole up to 200 characters, else its first and last characters.
[[nodiscard]] std::string shown_path(std::string_view path);

}  // namespace detp
