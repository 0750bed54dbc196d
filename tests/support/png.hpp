#pragma once

#include <zlib.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

/// Reads the PNG files that pictures are: 8 bits of red, green and blue, rows without filter or with differences from the left.
namespace detp::support {

struct Pixels {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::array<std::uint8_t, 3>> colours = {};

  [[nodiscard]] const std::array<std::uint8_t, 3>& at(std::uint32_t x, std::uint32_t y) const {
    return colours.at(y * width + x);
  }
};

inline std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<unsigned char>(bytes.at(at + i));
  return number;
}

inline Pixels pixels_of(const std::string& png) {
  const auto require = [](bool right, const char* what) {
    if (!right) throw std::runtime_error(std::string("not a PNG of ours: ") + what);
  };
  require(png.starts_with("\x89PNG\r\n\x1a\n"), "signature");
  Pixels picture;
  std::string packed;
  for (std::size_t at = 8; at < png.size();) {
    const std::uint32_t length = big_endian(png, at);
    const std::string name = png.substr(at + 4, 4);
    const std::string checked = png.substr(at + 4, length + 4);
    const auto checksum = crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
    require(checksum == big_endian(png, at + 8 + length), "checksum");
    if (name == "IHDR") {
      picture.width = big_endian(png, at + 8);
      picture.height = big_endian(png, at + 12);
      require(png.substr(at + 16, 5) == std::string("\x08\x02\0\0\0", 5), "kind");
    }
    if (name == "IDAT") packed += png.substr(at + 8, length);
    at += 12 + length;
  }
  const std::size_t row = 1 + 3 * std::size_t{picture.width};
  std::string rows(row * picture.height, '\0');
  uLongf size = rows.size();
  require(uncompress(reinterpret_cast<Bytef*>(rows.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
                     packed.size()) == Z_OK &&
              size == rows.size(),
          "length");
  for (std::size_t y = 0; y < picture.height; ++y) {
    require(rows[y * row] == 0 || rows[y * row] == 1, "filter");
    std::array<std::uint8_t, 3> left{};
    for (std::size_t x = 0; x < picture.width; ++x) {
      for (std::size_t part = 0; part < 3; ++part) {
        const auto stored = static_cast<std::uint8_t>(rows[y * row + 1 + 3 * x + part]);
        left[part] = static_cast<std::uint8_t>(stored + (rows[y * row] == 1 ? left[part] : 0));
      }
      picture.colours.push_back(left);
    }
  }
  return picture;
}

}  // namespace detp::support
