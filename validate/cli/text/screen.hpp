#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// The width in columns of the output stream, and whether it shows colours. Text is formatted accordingly: sentences, and
/// blocks side by side.
namespace detp::cli {

/// The value of --color: text is coloured if the stream shows colours, always, or never.
enum class Colour { automatic, always, never };

struct Screen {
  std::size_t width = 0;  ///< in columns; 0 means unlimited
  bool colour = false;

  /// The width for sentences, in columns: that of the screen, but at most 120.
  [[nodiscard]] std::size_t text_width() const;
};

/// The properties of a stream, for instance STDOUT_FILENO.
///
/// If the stream is a terminal, the width is that of the terminal. Otherwise the width is the value of the environment
/// variable COLUMNS if that is a whole number of at least 1. Otherwise the width is unlimited, so tables in files and
/// pipes keep all their columns.
///
/// With Colour::automatic, only a terminal shows colours. It shows none if NO_COLOR is set and not empty, or if TERM is
/// "dumb". Colour::always and Colour::never apply to any stream.
[[nodiscard]] Screen screen_of(int stream, Colour colour);

enum class Style { plain, strong, good, bad, doubtful, faint };

/// Returns the text in the colour of the style. Returns it unchanged if the screen shows no colours.
[[nodiscard]] std::string styled(const Screen& screen, Style style, std::string_view text);

/// Returns the text with control characters escaped, except line feeds. If `colour` is true, the escape sequences of
/// styled() are kept too.
[[nodiscard]] std::string safe_text(std::string_view text, bool colour = false);

/// The width of a text in columns: the number of its UTF-8 characters, without the escape sequences of colours.
[[nodiscard]] std::size_t columns_of(std::string_view text);

/// Breaks each line of a text between words into lines of at most `width` columns; a longer word stays whole. Of the
/// lines into which a line is broken, all except the first are indented. The result ends with a line feed.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t width, std::size_t indent = 0);

[[nodiscard]] std::string legend(const Screen& screen, std::string_view text);

struct TextBlock {
  std::vector<std::string> lines;

  /// That of the longest line.
  [[nodiscard]] std::size_t width() const;
};

/// The blocks after the first one, side by side as far as they fit the screen, and then below. The first block (labels
/// of the lines) begins each such strip, which an empty line ends. All blocks must have equally many lines.
[[nodiscard]] std::string side_by_side(const std::vector<TextBlock>& blocks, const Screen& screen);

/// Whether the first block and another one do not fit the screen.
[[nodiscard]] bool is_too_wide(const std::vector<TextBlock>& blocks, const Screen& screen);

}  // namespace detp::cli
