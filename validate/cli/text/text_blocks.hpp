#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "screen.hpp"

/// Blocks of text side by side.
namespace detp::cli {

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
