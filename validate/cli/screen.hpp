#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// The place where text is shown: its width, and whether it shows colours.
namespace detp::cli {

/// When text is coloured: --color.
enum class Colour { automatic, always, never };

struct Screen {
  std::size_t width = 0;  ///< columns; 0: as many as the text needs
  bool colour = false;

  /// Columns for sentences: at most 120, however wide the screen.
  [[nodiscard]] std::size_t text_width() const;
};

/// What a stream (STDOUT_FILENO, say) shows.
///
/// The width is that of the terminal; elsewhere the environment variable COLUMNS, if it is a whole number from 1 on; else
/// there is no limit, so that files and pipes lose no column of a table. Colours are shown on a terminal alone, and
/// there unless NO_COLOR is set and not empty or TERM is "dumb"; `always` and `never` decide for any stream.
[[nodiscard]] Screen screen_of(int stream, Colour colour);

enum class Style { plain, strong, good, bad, doubtful, faint };

/// The text with the colour of a style, if the screen shows colours; else the text alone.
[[nodiscard]] std::string styled(const Screen& screen, Style style, std::string_view text);

/// The text with control characters escaped, except ends of lines and, where colours are shown, what styled() adds.
[[nodiscard]] std::string safe_text(std::string_view text, bool colour = false);

/// Columns that a text takes: its characters in UTF-8, those of colours not counted.
[[nodiscard]] std::size_t columns_of(std::string_view text);

/// Each line of a text in lines of at most `width` columns where words allow it, all but its first indented. Ends with
/// \n.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t width, std::size_t indent = 0);

/// An explanation under a table: wrapped, and faint.
[[nodiscard]] std::string legend(const Screen& screen, std::string_view text);

}  // namespace detp::cli
