#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "svg.hpp"

/// A picture of pixels, and its file.
namespace detp::validate {

/// Red, green, blue of sRGB.
using Colour = std::array<std::uint8_t, 3>;

/// "#rrggbb".
[[nodiscard]] std::string hex(const Colour& colour);

class Bitmap {
 public:
  /// White.
  Bitmap(int width, int height);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  Colour& at(int x, int y) {
    return pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
  }

  void rectangle(const Rectangle& place, const Colour& colour);
  /// The other's upper left corner comes to (x, y); all of it must be within.
  void image(int x, int y, const Bitmap& other);
  /// `y` is the line on which letters stand. Letters are capitals or small alike; what has no letter here (ASCII alone has) is a gap.
  void text(int x, int y, std::string_view text, Anchor anchor);

  /// As PNG (8 bits a colour).
  [[nodiscard]] std::string png() const;

 private:
  int width_;
  int height_;
  std::vector<Colour> pixels_;
};

/// Base64 of RFC 4648.
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace detp::validate
