#pragma once

#include <span>
#include <string>
#include <string_view>

/// Makes text from outside (a file, an option, a file's name) safe to show in a message.
namespace detp {

/// Maximum number of characters of one quoted piece of input.
inline constexpr std::size_t longest_quote = 60;

/// Escapes everything that could change how a terminal shows the text: control characters (C0, DEL, C1), bytes that are
/// not valid UTF-8, line separators and marks of writing direction. Each such byte is replaced by text like \x1b.
/// Nothing else changes, so escaping twice equals escaping once.
[[nodiscard]] std::string escaped(std::string_view text);

/// Escaped and truncated after `most` characters; "..." shows the truncation.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t most = longest_quote);

/// The text escaped, truncated after `longest_quote` characters, and in double quotes.
[[nodiscard]] std::string quoted(std::string_view text);

/// A file's path, escaped. If it has more than 200 characters, "..." replaces some after the first 60,
/// so that about 200 remain.
[[nodiscard]] std::string shown_path(std::string_view path);

/// The edit distance of two words: the smallest number of changes that turn a into b. A change inserts, deletes or
/// replaces a letter, or swaps two neighbouring letters. Each letter is changed at most once.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// For a message about an unknown name: "; did you mean octree?". Empty if the nearest name's edit distance from the
/// word is more than 3, or more than a third of the word's length (rounded up), or if the word has more than 40
/// letters.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string_view> names);

}  // namespace detp
