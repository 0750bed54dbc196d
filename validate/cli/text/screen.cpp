#include "screen.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <cstring>

#include "detp/model/vocabulary/quoted.hpp"

namespace detp::cli {
namespace {

constexpr std::size_t widest_text = 120;
constexpr std::string_view end_of_style = "\033[0m";

/// By Style.
constexpr std::array<std::string_view, 6> colour_codes{"", "\033[1m", "\033[32m", "\033[31m", "\033[33m", "\033[2m"};

std::string_view environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::size_t width_of(int stream) {
  winsize size{};
  if (isatty(stream) == 1 && ::ioctl(stream, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  const std::string_view columns = environment("COLUMNS");
  std::size_t width = 0;
  const auto [end, error] = std::from_chars(columns.data(), columns.data() + columns.size(), width);
  return error == std::errc{} && end == columns.data() + columns.size() ? width : 0;
}

bool shows_colours(int stream) {
  return isatty(stream) == 1 && environment("NO_COLOR").empty() && environment("TERM") != "dumb";
}

std::string_view code_at(std::string_view text) {
  if (text.starts_with(end_of_style)) return end_of_style;
  for (const std::string_view code : colour_codes)
    if (!code.empty() && text.starts_with(code)) return code;
  return "";
}

std::string wrapped_paragraph(std::string_view paragraph, std::size_t width, std::size_t indent) {
  std::string lines;
  std::size_t used = 0;
  while (!paragraph.empty()) {
    const std::size_t start = std::min(paragraph.find_first_not_of(' '), paragraph.size());
    const std::size_t end = std::min(paragraph.find(' ', start), paragraph.size());
    const std::string_view word = paragraph.substr(0, end);  // with the spaces before it
    paragraph.remove_prefix(end);
    if (used > indent && used + columns_of(word) > width) {
      lines += "\n" + std::string(indent, ' ') + std::string(word.substr(start));
      used = indent + columns_of(word.substr(start));
    } else {
      lines += word;
      used += columns_of(word);
    }
  }
  return lines;
}

constexpr std::size_t between_blocks = 2;

bool fits(std::size_t width, const Screen& screen) { return screen.width == 0 || width <= screen.width; }

std::string strip(const std::vector<const TextBlock*>& blocks) {
  std::string text;
  for (std::size_t i = 0; i < blocks.front()->lines.size(); ++i) {
    std::string line;
    for (const TextBlock* block : blocks) {
      const std::string& part = block->lines[i];
      line += (block == blocks.front() ? "" : std::string(between_blocks, ' ')) + part;
      line += std::string(block->width() - columns_of(part), ' ');
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text + "\n";
}

}  // namespace

std::size_t Screen::text_width() const { return width == 0 ? widest_text : std::min(width, widest_text); }

Screen screen_of(int stream, Colour colour) {
  return {width_of(stream), colour == Colour::always || (colour == Colour::automatic && shows_colours(stream))};
}

std::string styled(const Screen& screen, Style style, std::string_view text) {
  std::string shown(text);
  if (screen.colour && style != Style::plain)
    shown = std::string(colour_codes[static_cast<std::size_t>(style)]) + shown + std::string(end_of_style);
  return shown;
}

std::string safe_text(std::string_view text, bool colour) {
  std::string safe;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(colour ? "\n\033" : "\n"), text.size());
    safe += escaped(text.substr(0, end));
    text.remove_prefix(end);
    if (text.empty()) break;
    const std::string_view kept = text.front() == '\n' ? text.substr(0, 1) : code_at(text);
    safe += kept.empty() ? escaped(text.substr(0, 1)) : std::string(kept);
    text.remove_prefix(std::max<std::size_t>(1, kept.size()));
  }
  return safe;
}

std::size_t columns_of(std::string_view text) {
  std::size_t columns = 0;
  while (!text.empty()) {
    const std::size_t code = code_at(text).size();
    if (code == 0 && (static_cast<unsigned char>(text.front()) & 0xc0U) != 0x80) ++columns;
    text.remove_prefix(std::max<std::size_t>(1, code));
  }
  return columns;
}

std::string wrapped(std::string_view text, std::size_t width, std::size_t indent) {
  std::string lines;
  do {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines += wrapped_paragraph(text.substr(0, end), width, indent) + "\n";
    text.remove_prefix(std::min(end + 1, text.size()));
  } while (!text.empty());
  return lines;
}

std::string legend(const Screen& screen, std::string_view text) {
  std::string lines = wrapped(text, screen.text_width());
  lines.pop_back();
  return styled(screen, Style::faint, lines) + "\n";
}

std::size_t TextBlock::width() const {
  std::size_t widest = 0;
  for (const std::string& line : lines) widest = std::max(widest, columns_of(line));
  return widest;
}

std::string side_by_side(const std::vector<TextBlock>& blocks, const Screen& screen) {
  std::string text;
  for (std::size_t next = 1; next < blocks.size();) {
    std::vector<const TextBlock*> shown{&blocks.front()};
    std::size_t width = blocks.front().width();
    do {
      width += between_blocks + blocks[next].width();
      shown.push_back(&blocks[next++]);
    } while (next < blocks.size() && fits(width + between_blocks + blocks[next].width(), screen));
    text += strip(shown);
  }
  return text;
}

bool is_too_wide(const std::vector<TextBlock>& blocks, const Screen& screen) {
  return std::any_of(blocks.begin() + 1, blocks.end(), [&](const TextBlock& block) {
    return !fits(blocks.front().width() + between_blocks + block.width(), screen);
  });
}

}  // namespace detp::cli
