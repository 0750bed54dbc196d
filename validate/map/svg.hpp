#pragma once

#include <string>
#include <string_view>

/// Writes a picture as SVG 1.1. It refers to nothing outside itself. Coordinates are in points; y grows downwards.
namespace detp::validate {

/// The text with the characters that XML reserves replaced, and without those that XML forbids.
[[nodiscard]] std::string xml_text(std::string_view text);

enum class Anchor { start, middle, end };

struct TextStyle {
  double size = 10;
  Anchor anchor = Anchor::start;
  std::string_view fill = "#000000";
  bool bold = false;
  bool upwards = false;  ///< turned by 90 degrees, to read from the bottom to the top
};

struct Rectangle {
  double x = 0;
  double y = 0;
  double width = 0;
  double height = 0;
};

class Svg {
 public:
  Svg(double width, double height, std::string_view title);

  /// `tip`, if not empty, is shown when the pointer is over the rectangle.
  void rectangle(const Rectangle& place, std::string_view fill, std::string_view stroke = "none",
                 std::string_view tip = {});
  void line(double x1, double y1, double x2, double y2, double width = 1);
  /// A right-angled triangle in the upper right corner at (x, y).
  void corner(double x, double y, double side, bool filled);
  void text(double x, double y, std::string_view text, const TextStyle& style = {});

  [[nodiscard]] std::string finished() const { return text_ + "</svg>\n"; }

 private:
  std::string text_;
};

}  // namespace detp::validate
