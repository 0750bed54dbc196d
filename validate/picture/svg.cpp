#include "svg.hpp"

#include <fmt/format.h>

#include <array>

namespace detp::validate {
namespace {

std::string class_of(const Paint& paint) {
  return paint.css_class.empty() ? "" : fmt::format(" class=\"{}\"", xml_text(paint.css_class));
}

/// The outline of a mark of half the size 1 around (0, 0); a cross has no inside.
std::string_view outline(Mark mark) {
  constexpr std::array<std::string_view, 6> outlines{"M-1 0a1 1 0 1 0 2 0a1 1 0 1 0 -2 0z",
                                                     "M-.9 -.9h1.8v1.8h-1.8z",
                                                     "M0 -1.25L1.25 0L0 1.25L-1.25 0z",
                                                     "M0 -1.1L1.1 .9h-2.2z",
                                                     "M0 1.1L1.1 -.9h-2.2z",
                                                     "M-.9 -.9L.9 .9M-.9 .9L.9 -.9"};
  return outlines[static_cast<std::size_t>(mark)];
}

}  // namespace

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

Svg Svg::in_page(double width, double height, std::string_view description) {
  Svg svg;
  svg.text_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\">\n",
      width, height, xml_text(description));
  svg.ink_ = "currentColor";
  return svg;
}

void Svg::rectangle(const Rectangle& place, std::string_view fill, std::string_view stroke, std::string_view tip) {
  text_ += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\" stroke=\"{}\"",
                       place.x, place.y, place.width, place.height, fill, stroke);
  text_ += tip.empty() ? "/>\n" : fmt::format("><title>{}</title></rect>\n", xml_text(tip));
}

void Svg::image(const Rectangle& place, std::string_view address) {
  text_ += fmt::format(
      "<image xmlns:xlink=\"http://www.w3.org/1999/xlink\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" "
      "height=\"{:.2f}\" xlink:href=\"{}\"/>\n",
      place.x, place.y, place.width, place.height, address);
}

void Svg::line(double x1, double y1, double x2, double y2, double width) {
  text_ += fmt::format(
      "<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" stroke=\"{}\" stroke-width=\"{:.2f}\"/>\n", x1, y1,
      x2, y2, ink_, width);
}

void Svg::rule(double x1, double y1, double x2, double y2, bool dashed) {
  text_ += fmt::format(
      "<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
      "stroke-opacity=\"{}\"{}/>\n",
      dashed ? "limit" : "grid", x1, y1, x2, y2, ink_, dashed ? "0.8" : "0.15",
      dashed ? " stroke-dasharray=\"4 3\"" : "");
}

void Svg::polyline(const std::vector<std::pair<double, double>>& points, const Paint& paint) {
  text_ += fmt::format("<polyline{} fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\" points=\"", class_of(paint),
                       paint.colour);
  for (const auto& [x, y] : points) text_ += fmt::format("{:.1f},{:.1f} ", x, y);
  text_ += "\"/>\n";
}

void Svg::corner(double x, double y, double side, bool filled) {
  text_ += fmt::format("<path d=\"M{:.2f} {:.2f}h{:.2f}v{:.2f}z\" fill=\"{}\" stroke=\"#000000\"/>\n", x - side, y,
                       side, side, filled ? "#000000" : "#ffffff");
}

void Svg::mark(Mark mark, double x, double y, double size, const Paint& paint, bool filled) {
  text_ += fmt::format(
      "<path{} d=\"{}\" transform=\"translate({:.1f} {:.1f}) scale({:.2f})\" stroke-width=\"{:.2f}\" stroke=\"{}\" "
      "fill=\"{}\"{}/>\n",
      class_of(paint), outline(mark), x, y, size / 2, 2.8 / size, paint.colour, paint.colour,
      filled && mark != Mark::cross ? "" : " fill-opacity=\"0\"");
}

void Svg::text(double x, double y, std::string_view text, const TextStyle& style) {
  constexpr std::array<std::string_view, 3> anchors{"start", "middle", "end"};
  text_ +=
      fmt::format("<text x=\"{0:.2f}\" y=\"{1:.2f}\" font-size=\"{2:.2f}\" text-anchor=\"{3}\" fill=\"{4}\"", x, y,
                  style.size, anchors[static_cast<std::size_t>(style.anchor)], style.fill.empty() ? ink_ : style.fill);
  if (style.bold) text_ += " font-weight=\"bold\"";
  if (style.upwards) text_ += fmt::format(" transform=\"rotate(-90 {:.2f} {:.2f})\"", x, y);
  text_ += fmt::format(">{}</text>\n", xml_text(text));
}

void Svg::begin_value(std::string_view value) {
  text_ += fmt::format("<g data-value=\"{0}\"><title>{0}</title>\n", xml_text(value));
}

}  // namespace detp::validate
