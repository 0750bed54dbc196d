#pragma once

#include <optional>
#include <string_view>

namespace detp::sim {

/// The double nearest to the number that the whole text spells, in any locale; nullopt if the text is not a number.
///
/// Accepts a leading '+', and "inf", "infinity" and "nan" in upper or lower case. Numbers too large for a double become
/// infinite; numbers too near to zero become zero. Surrounding spaces are not accepted.
[[nodiscard]] std::optional<double> number_in(std::string_view text);

/// The text without leading and trailing blanks: spaces, tabs, form feeds.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// Returns the text up to the first character of `separators`; removes this text and the separator from `text`.
[[nodiscard]] std::string_view cut_until(std::string_view& text, std::string_view separators);

/// Returns the next word, a run of characters other than blanks, and removes it from the front of `text`; empty
/// at the end.
[[nodiscard]] std::string_view cut_word(std::string_view& text);

}  // namespace detp::sim
