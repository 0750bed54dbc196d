#include "quoted.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace detp {
namespace {

/// One character, or one byte that is not part of a valid character.
struct Piece {
  std::size_t bytes = 1;
  char32_t point = 0;
  bool valid = false;
};

/// The character at the front of the text. The text must not be empty.
Piece first_piece(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {1, lead, true};
  const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes) return {};
  auto point = static_cast<char32_t>(lead & (0x7f >> bytes));
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    point = (point << 6) | (byte(i) & 0x3f);
  }
  constexpr std::array<char32_t, 5> least{0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = point >= 0xd800 && point <= 0xdfff;
  if (point < least[bytes] || point > 0x10ffff || surrogate) return {};
  return {bytes, point, true};
}

bool is_safe(char32_t point) {
  const bool control = point < 0x20 || (point >= 0x7f && point < 0xa0);
  const bool directs = (point >= 0x200e && point <= 0x200f) || (point >= 0x2028 && point <= 0x202e) ||
                       (point >= 0x2066 && point <= 0x2069) || point == 0xfeff;
  return !control && !directs;
}

std::string escape_of(std::string_view bytes) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text;
  for (const char c : bytes) {
    const auto value = static_cast<unsigned char>(c);
    text += {'\\', 'x', digits[value >> 4], digits[value & 15]};
  }
  return text;
}

/// Removes the next character from the front of the text, and returns it as a message shows it.
std::string cut_escaped_character(std::string_view& text) {
  const Piece piece = first_piece(text);
  const std::string_view bytes = text.substr(0, piece.bytes);
  text.remove_prefix(piece.bytes);
  return piece.valid && is_safe(piece.point) ? std::string(bytes) : escape_of(bytes);
}

/// Columns of one piece on the screen: four for each escaped byte, one for any other character.
std::size_t width(const std::string& shown) { return shown.front() == '\\' ? shown.size() : 1; }

}  // namespace

std::string escaped(std::string_view text) {
  std::string shown;
  while (!text.empty()) shown += cut_escaped_character(text);
  return shown;
}

std::string shortened(std::string_view text, std::size_t most) {
  std::string shown;
  std::size_t characters = 0;
  while (!text.empty()) {
    const std::string next = cut_escaped_character(text);
    characters += width(next);
    if (characters > most) return shown + "...";
    shown += next;
  }
  return shown;
}

std::string quoted(std::string_view text) { return '"' + shortened(text) + '"'; }

std::string shown_path(std::string_view path) {
  constexpr std::size_t most = 200;
  constexpr std::size_t front = 60;
  std::vector<std::string> pieces;
  std::size_t characters = 0;
  for (std::string_view rest = path; !rest.empty();) {
    pieces.push_back(cut_escaped_character(rest));
    characters += width(pieces.back());
  }
  const std::size_t too_many = characters > most ? characters - (most - 3) : 0;
  std::string shown;
  std::size_t before = 0;
  bool cut = false;
  for (const std::string& piece : pieces) {
    const bool left_out = before >= front && before < front + too_many;
    if (!left_out) shown += piece;
    if (left_out && !cut) shown += "...";
    cut = cut || left_out;
    before += width(piece);
  }
  return shown;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // now[j]: distance between the first i letters of a and the first j of b. last: for i - 1; before: for i - 2.
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) now[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before, last);
    std::swap(last, now);
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = a[i - 1] == b[j - 1];
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) now[j] = std::min(now[j], before[j - 2] + 1);
    }
  }
  return now[b.size()];
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> names) {
  constexpr std::size_t longest = 40;  // a longer word is no misspelt name
  if (word.size() > longest) return "";
  std::size_t least = std::min<std::size_t>(3, (word.size() + 2) / 3) + 1;
  std::string_view nearest;
  for (const std::string_view name : names) {
    const std::size_t distance = edit_distance(word, name);
    if (distance >= least) continue;
    least = distance;
    nearest = name;
  }
  return nearest.empty() ? "" : "; did you mean " + std::string(nearest) + "?";
}

}  // namespace detp
