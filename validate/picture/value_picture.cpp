#include "value_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "labels.hpp"

namespace detp::validate {
namespace {

constexpr int margin = 16;
constexpr int title_room = 34;
constexpr int bar_gap = 14;
constexpr int bar_width = 20;
constexpr int label_room = 100;
constexpr int most_ticks = 7;
constexpr Colour background{255, 255, 255};
constexpr Colour unknown{190, 190, 190};

Colour colour_of_cell(const ValuePanel& panel, std::size_t cell) {
  const double number = panel.cells[cell];
  Colour colour = number == no_surface ? background
                  : std::isnan(number) ? unknown
                                       : scale_colour(panel.scale.share(number));
  if (panel.outlines[cell] != 0)
    for (std::uint8_t& part : colour) part = static_cast<std::uint8_t>(part / 2);
  return colour;
}

/// Each pixel is the mean of its cells.
Bitmap pixels_of(const ValuePanel& panel) {
  constexpr int fine = ValuePanel::fineness;
  Bitmap picture(panel.width, panel.height);
  for (int y = 0; y < panel.height; ++y)
    for (int x = 0; x < panel.width; ++x) {
      std::array<int, 3> sum{};
      for (int i = 0; i < fine * fine; ++i) {
        const auto row = static_cast<std::size_t>(fine * y + i / fine);
        const auto column = static_cast<std::size_t>(fine * x + i % fine);
        const Colour colour = colour_of_cell(panel, row * static_cast<std::size_t>(fine * panel.width) + column);
        for (std::size_t part = 0; part < 3; ++part) sum[part] += colour[part];
      }
      for (std::size_t part = 0; part < 3; ++part)
        picture.at(x, y)[part] = static_cast<std::uint8_t>((sum[part] + fine * fine / 2) / (fine * fine));
    }
  return picture;
}

/// What is drawn on: pixels.
class PixelSheet {
 public:
  PixelSheet(int width, int height) : bitmap_(width, height) {}
  void image(int x, int y, const Bitmap& picture) { bitmap_.image(x, y, picture); }
  void rectangle(const Rectangle& place, const Colour& colour) { bitmap_.rectangle(place, colour); }
  void text(int x, int y, const std::string& text) { bitmap_.text(x, y, text, Anchor::start); }
  [[nodiscard]] std::string finished() const { return bitmap_.png(); }

 private:
  Bitmap bitmap_;
};

/// What is drawn on: vectors.
class VectorSheet {
 public:
  VectorSheet(int width, int height, const std::string& description) : svg_(width, height, description) {}
  void image(int x, int y, const Bitmap& picture) {
    svg_.image({static_cast<double>(x), static_cast<double>(y), static_cast<double>(picture.width()),
                static_cast<double>(picture.height())},
               "data:image/png;base64," + base64(picture.png()));
  }
  void rectangle(const Rectangle& place, const Colour& colour) { svg_.rectangle(place, hex(colour)); }
  void text(int x, int y, const std::string& text) { svg_.text(x, y, text, {.size = 17}); }
  [[nodiscard]] std::string finished() const { return svg_.finished(); }

 private:
  Svg svg_;
};

/// "0.0005", "6000", "1.2e7".
std::string short_number(double number) {
  std::string text = fmt::format("{:.6g}", number);
  if (const std::size_t exponent = text.find('e'); exponent != std::string::npos)
    text = fmt::format("{}e{}", text.substr(0, exponent), std::stoi(text.substr(exponent + 1)));
  return text;
}

std::string title_of(const ValuePanel& panel) {
  std::string title = panel.title;
  if (panel.scale.largest > panel.scale.high) title += fmt::format(" (largest {})", number_label(panel.scale.largest));
  return title;
}

template <class Sheet>
void draw_bar(Sheet& sheet, const ValuePanel& panel, int left, int top) {
  constexpr int steps = 150;
  for (int i = 0; i < steps; ++i) {
    const int y = i * panel.height / steps;
    const int height = (i + 1) * panel.height / steps - y;
    sheet.rectangle({static_cast<double>(left), static_cast<double>(top + y), bar_width, static_cast<double>(height)},
                    scale_colour(1 - (i + 0.5) / steps));
  }
  for (const double tick : panel.scale.ticks(most_ticks)) {
    const double y = top + (1 - panel.scale.share(tick)) * panel.height;
    sheet.rectangle(
        {static_cast<double>(left + bar_width), std::clamp(y - 1, 1.0 * top, top + panel.height - 2.0), 6, 2},
        {0, 0, 0});
    sheet.text(left + bar_width + 10, static_cast<int>(y) + 7, short_number(tick));
  }
}

struct Size {
  int width;
  int height;
};

Size panel_size(const ValuePanel& panel) {
  return {panel.width + bar_gap + bar_width + label_room, title_room + panel.height + margin};
}

Size checked_size(const PanelRows& rows) {
  if (rows.empty() || rows.front().empty()) throw std::invalid_argument("a picture needs a panel");
  const ValuePanel& first = rows.front().front();
  std::size_t most = 0;
  for (const std::vector<ValuePanel>& row : rows) {
    most = std::max(most, row.size());
    for (const ValuePanel& panel : row) {
      const auto cells = static_cast<std::size_t>(panel.width) * static_cast<std::size_t>(panel.height) *
                         static_cast<std::size_t>(ValuePanel::fineness * ValuePanel::fineness);
      if (panel.width != first.width || panel.height != first.height || panel.cells.size() != cells ||
          panel.outlines.size() != cells || cells == 0)
        throw std::invalid_argument("panels of a picture have the same size, and a number for each cell");
    }
  }
  const Size one = panel_size(first);
  return {margin + static_cast<int>(most) * one.width, margin + static_cast<int>(rows.size()) * one.height};
}

template <class Sheet>
std::string drawn(Sheet sheet, const PanelRows& rows) {
  int top = margin;
  for (const std::vector<ValuePanel>& row : rows) {
    int left = margin;
    for (const ValuePanel& panel : row) {
      sheet.text(left, top + title_room - 14, title_of(panel));
      sheet.image(left, top + title_room, pixels_of(panel));
      draw_bar(sheet, panel, left + panel.width + bar_gap, top + title_room);
      left += panel_size(panel).width;
    }
    top += panel_size(row.front()).height;
  }
  return sheet.finished();
}

}  // namespace

std::string picture_png(const PanelRows& rows) {
  const Size size = checked_size(rows);
  return drawn(PixelSheet(size.width, size.height), rows);
}

std::string picture_svg(const PanelRows& rows, const std::string& description) {
  const Size size = checked_size(rows);
  return drawn(VectorSheet(size.width, size.height, description), rows);
}

}  // namespace detp::validate
