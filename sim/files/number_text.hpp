#pragma once

#include <optional>
#include <string_view>

namespace detp::sim {

/// The double nearest to the number that the whole text spells, whatever the locale; nothing where it spells none.
///
/// Accepts a leading '+', "inf", "infinity" and "nan" in any case. Numbers too large for a double become infinite,
/// numbers too small zero. Surrounding spaces are not accepted.
[[nodiscard]] std::optional<double> number_in(std::string_view text);

/// The text without spaces and tabs at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// The text up to the first of `separators`, which is cut off the front of `text` together with that separator.
[[nodiscard]] std::string_view cut_until(std::string_view& text, std::string_view separators);

/// The next run of characters that are no blanks (space, tab), cut off the front of `text`; empty at its end.
[[nodiscard]] std::string_view cut_word(std::string_view& text);

}  // namespace detp::sim
