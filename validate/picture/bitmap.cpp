#include "bitmap.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>

#include "letters.hpp"

namespace detp::validate {
namespace {

constexpr int letter_size = 2;  // pixels of a letter's cell
constexpr int letter_step = letter_size * (letter_width + 1);

/// The sheet and the column of a letter; none for others.
const LetterSheet* sheet_of(char letter, std::size_t& column) {
  for (const LetterSheet& sheet : letter_sheets)
    if (const std::size_t place = sheet.letters.find(letter); place != std::string_view::npos) {
      column = place * (letter_width + 1);
      return &sheet;
    }
  return nullptr;
}

void append_big_endian(std::string& bytes, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xFFU);
}

/// A chunk of a PNG file: length, name, bytes, and the checksum of name and bytes.
void append_chunk(std::string& file, std::string_view name, std::string_view bytes) {
  append_big_endian(file, static_cast<std::uint32_t>(bytes.size()));
  std::string checked(name);
  checked.append(bytes);
  file += checked;
  append_big_endian(
      file, static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(checked.data()), checked.size())));
}

std::string packed(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string result(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(result.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), Z_DEFAULT_COMPRESSION) != Z_OK)
    throw std::bad_alloc();  // the only other reason would be a small buffer
  result.resize(size);
  return result;
}

}  // namespace

std::string hex(const Colour& colour) { return fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]); }

Bitmap::Bitmap(int width, int height)
    : width_(width),
      height_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), {255, 255, 255}) {}

void Bitmap::rectangle(const Rectangle& place, const Colour& colour) {
  const auto pixel = [](double at, int most) { return std::clamp(static_cast<int>(std::lround(at)), 0, most); };
  for (int y = pixel(place.y, height_); y < pixel(place.y + place.height, height_); ++y)
    for (int x = pixel(place.x, width_); x < pixel(place.x + place.width, width_); ++x) at(x, y) = colour;
}

void Bitmap::image(int x, int y, const Bitmap& other) {
  for (int row = 0; row < other.height_; ++row)
    std::copy_n(other.pixels_.begin() + static_cast<std::ptrdiff_t>(row) * other.width_, other.width_,
                pixels_.begin() + static_cast<std::ptrdiff_t>(y + row) * width_ + x);
}

void Bitmap::text(int x, int y, std::string_view text, Anchor anchor) {
  const int length = letter_step * static_cast<int>(text.size());
  x -= anchor == Anchor::start ? 0 : anchor == Anchor::end ? length : length / 2;
  for (const char letter : text) {
    std::size_t column = 0;
    const bool capital = letter >= 'A' && letter <= 'Z';
    if (const LetterSheet* sheet = sheet_of(capital ? static_cast<char>(letter - 'A' + 'a') : letter, column))
      for (int row = 0; row < letter_rows; ++row)
        for (int cell = 0; cell < letter_width; ++cell)
          if (sheet->rows[static_cast<std::size_t>(row)][column + static_cast<std::size_t>(cell)] == '#')
            rectangle({static_cast<double>(x + letter_size * cell),
                       static_cast<double>(y + letter_size * (row - letter_rows_above)), letter_size, letter_size},
                      {0, 0, 0});
    x += letter_step;
  }
}

std::string Bitmap::png() const {
  std::string file = "\x89PNG\r\n\x1a\n";
  std::string head;
  append_big_endian(head, static_cast<std::uint32_t>(width_));
  append_big_endian(head, static_cast<std::uint32_t>(height_));
  head += std::string("\x08\x02\0\0\0", 5);  // 8 bits; red, green, blue; deflate, filters of rows, not interlaced
  append_chunk(file, "IHDR", head);
  append_chunk(file, "sRGB", std::string_view("\0", 1));
  constexpr char difference_from_left = 1;
  std::string rows;
  rows.reserve(pixels_.size() * 3 + static_cast<std::size_t>(height_));
  for (std::size_t y = 0; y < static_cast<std::size_t>(height_); ++y) {
    rows += difference_from_left;
    Colour left{0, 0, 0};
    for (std::size_t x = 0; x < static_cast<std::size_t>(width_); ++x) {
      const Colour& own = pixels_[y * static_cast<std::size_t>(width_) + x];
      for (std::size_t i = 0; i < own.size(); ++i) rows += static_cast<char>(own[i] - left[i]);
      left = own;
    }
  }
  append_chunk(file, "IDAT", packed(rows));
  append_chunk(file, "IEND", "");
  return file;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t j = 0; j < 3; ++j)
      three = three << 8 | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0U);
    for (std::size_t j = 0; j < 4; ++j) text += i + j <= bytes.size() ? digits[three >> (18 - 6 * j) & 63U] : '=';
  }
  return text;
}

}  // namespace detp::validate
