#include "svg.hpp"

#include <fmt/format.h>

#include <array>

namespace detp::validate {

std::string xml_text(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '"')
      safe += "&quot;";
    else if (static_cast<unsigned char>(c) >= ' ' || c == '\n')
      safe += c;
  }
  return safe;
}

Svg::Svg(double width, double height, std::string_view title)
    : text_(fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                        "<svg xmlns=\"http://www.w3.org/2000/svg\" version=\"1.1\" width=\"{0:.2f}\" "
                        "height=\"{1:.2f}\" viewBox=\"0 0 {0:.2f} {1:.2f}\" font-family=\"sans-serif\">\n"
                        "<title>{2}</title>\n",
                        width, height, xml_text(title))) {
  rectangle({0, 0, width, height}, "#ffffff");
}

void Svg::rectangle(const Rectangle& place, std::string_view fill, std::string_view stroke, std::string_view tip) {
  text_ += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\" stroke=\"{}\"",
                       place.x, place.y, place.width, place.height, fill, stroke);
  text_ += tip.empty() ? "/>\n" : fmt::format("><title>{}</title></rect>\n", xml_text(tip));
}

void Svg::line(double x1, double y1, double x2, double y2, double width) {
  text_ += fmt::format(
      "<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" stroke=\"#000000\" stroke-width=\"{:.2f}\"/>\n",
      x1, y1, x2, y2, width);
}

void Svg::corner(double x, double y, double side, bool filled) {
  text_ += fmt::format("<path d=\"M{:.2f} {:.2f}h{:.2f}v{:.2f}z\" fill=\"{}\" stroke=\"#000000\"/>\n", x - side, y,
                       side, side, filled ? "#000000" : "#ffffff");
}

void Svg::text(double x, double y, std::string_view text, const TextStyle& style) {
  constexpr std::array<std::string_view, 3> anchors{"start", "middle", "end"};
  text_ += fmt::format("<text x=\"{0:.2f}\" y=\"{1:.2f}\" font-size=\"{2:.2f}\" text-anchor=\"{3}\" fill=\"{4}\"", x, y,
                       style.size, anchors[static_cast<std::size_t>(style.anchor)], style.fill);
  if (style.bold) text_ += " font-weight=\"bold\"";
  if (style.upwards) text_ += fmt::format(" transform=\"rotate(-90 {:.2f} {:.2f})\"", x, y);
  text_ += fmt::format(">{}</text>\n", xml_text(text));
}

}  // namespace detp::validate
