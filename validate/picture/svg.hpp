#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Writes a picture as SVG 1.1. It refers to nothing outside itself. Coordinates are in points; y grows downwards.
namespace detp::validate {

/// The text with the characters that XML reserves replaced, and without those that XML forbids.
[[nodiscard]] std::string xml_text(std::string_view text);

enum class Anchor { start, middle, end };

struct TextStyle {
  double size = 10;
  Anchor anchor = Anchor::start;
  std::string_view fill = {};  ///< empty: the picture's ink
  bool bold = false;
  bool upwards = false;  ///< turned by 90 degrees, to read from the bottom to the top
};

struct Rectangle {
  double x = 0;
  double y = 0;
  double width = 0;
  double height = 0;
};

/// The shape of a point.
enum class Mark { circle, square, diamond, up, down, cross };

/// A colour, and the name of a CSS class by which a page may change it; empty: none.
struct Paint {
  std::string_view colour;
  std::string_view css_class = {};
};

class Svg {
 public:
  /// A file of its own: a white sheet with black ink.
  Svg(double width, double height, std::string_view title);
  /// A part of a page, as wide as the page lets it be, in the page's ink. `description` is for those who do not see it.
  static Svg in_page(double width, double height, std::string_view description);

  /// `tip`, if not empty, is shown when the pointer is over the rectangle.
  void rectangle(const Rectangle& place, std::string_view fill, std::string_view stroke = "none",
                 std::string_view tip = {});
  /// A picture of pixels, as "data:image/png;base64,…".
  void image(const Rectangle& place, std::string_view address);
  void line(double x1, double y1, double x2, double y2, double width = 1);
  /// A thin line across the picture: of the grid, or dashed.
  void rule(double x1, double y1, double x2, double y2, bool dashed = false);
  void polyline(const std::vector<std::pair<double, double>>& points, const Paint& paint);
  /// A right-angled triangle in the upper right corner at (x, y).
  void corner(double x, double y, double side, bool filled);
  void mark(Mark mark, double x, double y, double size, const Paint& paint, bool filled = true);
  void text(double x, double y, std::string_view text, const TextStyle& style = {});

  /// What follows until end_value() belongs together and has this value in words.
  void begin_value(std::string_view value);
  void end_value() { text_ += "</g>\n"; }

  [[nodiscard]] std::string finished() const { return text_ + "</svg>\n"; }

 private:
  Svg() = default;

  std::string text_;
  std::string_view ink_ = "#000000";
};

}  // namespace detp::validate
