#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "detp/validate/picture/labels.hpp"
#include "detp/validate/picture/svg.hpp"
#include "map_summary.hpp"

namespace detp::validate {
namespace {

constexpr double panel_width = 340;
constexpr double panel_height = 280;
constexpr double left = 78;  // room for the labels of radii
constexpr double right = 70;
constexpr double top = 98;
constexpr double between = 26;  // panels
constexpr double below = 60;    // the panels: labels of rays, then the legend
constexpr double legend_column = 150;
constexpr double legend_line = 18;
constexpr double small = 9;
constexpr double text_size = 11;
constexpr double letter = 0.6;  // width of a character over its size, about; the font is the viewer's

/// What a panel shows in a cell.
struct Sign {
  Technique technique;
  std::string tip;
  std::optional<double> seconds = {};
  std::optional<CellVerdict> verdict = {};
};

using SignOf = std::function<std::optional<Sign>(const MapCell&)>;

struct Panel {
  std::string title;
  SignOf sign_of;
};

std::optional<Sign> predicted_sign(const MapCell& cell) {
  if (!cell.choice) return std::nullopt;
  const Prediction& choice = cell.choice->best();
  const double seconds = choice.time.total();
  return Sign{choice.candidate.technique,
              fmt::format("{}, predicted {}", title(choice.candidate), seconds_label(seconds)), seconds};
}

std::optional<Sign> measured_sign(const MapCell& cell) {
  if (!cell.analysis) return std::nullopt;
  const Analysed& best = *cell.fastest();
  const CellVerdict verdict = *cell.verdict();
  std::string tip = fmt::format("{}, measured {}", title(best.candidate), seconds_label(*best.seconds));
  if (!verdict.agrees)
    tip += fmt::format("; {} takes {:.2g} % longer", title(cell.analysis->candidates.front().candidate),
                       100 * verdict.slower);
  return Sign{best.candidate.technique, std::move(tip), best.seconds, verdict};
}

std::optional<Sign> paper_sign(const MapCell& cell) { return Sign{cell.paper.technique, title(cell.paper)}; }

/// Positions of the edges of cells along an axis of this length.
std::vector<double> axis_places(const std::vector<double>& values, double length) {
  std::vector<double> edges = cell_edges(values);
  const double first = std::log(edges.front());
  const double range = std::log(edges.back()) - first;
  for (double& edge : edges) edge = length * (std::log(edge) - first) / range;
  return edges;
}

class MapDrawing {
 public:
  MapDrawing(const TechniqueMap& map, const std::string& machine, const std::string& program)
      : map_(map),
        machine_(machine),
        program_(program),
        agreement_(agreement_of(map)),
        xs_(axis_places(map.rays, panel_width)) {
    std::vector<double> radii;
    for (const MapRow& row : map.rows) radii.push_back(row.workload.disc_radius);
    ys_ = axis_places(radii, panel_height);
    panels_.push_back({"predicted", predicted_sign});
    if (agreement_.cells > 0) panels_.push_back({"measured", measured_sign});
    panels_.push_back({"the paper's rule (limits: X = 2 and X = 6)", paper_sign});
    for (const Technique technique : all_techniques)
      if (is_present(technique)) present_.push_back(technique);
  }

  std::string draw() {
    const auto panels = static_cast<double>(panels_.size());
    const double width = left + panels * panel_width + (panels - 1) * between + right;
    const auto columns = static_cast<std::size_t>((width - left) / legend_column);
    const double legend_lines =
        std::ceil(static_cast<double>(present_.size()) / static_cast<double>(columns)) + (agreement_.cells > 0 ? 1 : 0);
    const double bottom = top + panel_height + below;
    Svg svg(width, bottom + legend_line * legend_lines, "Fastest technique: " + describe(map_));
    draw_caption(svg, width - left - 10);
    for (std::size_t i = 0; i < panels_.size(); ++i)
      draw_panel(svg, panels_[i], left + static_cast<double>(i) * (panel_width + between));
    draw_radii(svg, width);
    draw_legend(svg, bottom, columns);
    return svg.finished();
  }

 private:
  [[nodiscard]] bool is_present(Technique technique) const {
    for (const Panel& panel : panels_)
      for (const PlacedCell& one : map_.cells())
        if (const auto sign = panel.sign_of(*one.cell); sign && sign->technique == technique) return true;
    return false;
  }

  /// Lines at most `width` wide: long ones have a smaller font.
  void draw_caption(Svg& svg, double width) const {
    const auto add = [&](double y, const std::string& text, double size, bool bold = false) {
      svg.text(left, y, text,
               {.size = std::min(size, width / (letter * static_cast<double>(text.size()))), .bold = bold});
    };
    add(22, "Fastest technique by number of rays and disc radius", 15, true);
    add(39, describe(map_), text_size);
    std::string line = fmt::format("{}, {}, one thread", machine_, program_);
    if (agreement_.cells > 0)
      line += fmt::format("; measured technique as predicted in {} of {} cells ({:.0f} %)", agreement_.agree,
                          agreement_.cells, 100 * agreement_.share());
    if (map_.stopped)
      line += fmt::format("; stopped after {} of {} {}", map_.stopped->done, map_.stopped->of, map_.stopped->unit);
    add(54, line, text_size);
    add(69, "unit costs " + map_.costs_origin, small);
  }

  void draw_panel(Svg& svg, const Panel& panel, double x) const {
    svg.text(x, top - 8, panel.title, {.size = text_size, .bold = true});
    std::vector<std::vector<std::optional<Sign>>> signs;
    for (const MapRow& row : map_.rows) {
      auto& line = signs.emplace_back();
      for (const MapCell& cell : row.cells) line.push_back(panel.sign_of(cell));
    }
    for (std::size_t j = 0; j < signs.size(); ++j)
      for (std::size_t i = 0; i < signs[j].size(); ++i) draw_cell(svg, x, i, j, signs[j][i]);
    for (std::size_t j = 0; j < signs.size(); ++j)
      for (std::size_t i = 0; i < signs[j].size(); ++i) {
        const Rectangle place = place_of(x, i, j);
        if (i > 0 && differ(signs[j][i - 1], signs[j][i]))
          svg.line(place.x, place.y, place.x, place.y + place.height, 2);
        if (j > 0 && differ(signs[j - 1][i], signs[j][i]))
          svg.line(place.x, place.y + place.height, place.x + place.width, place.y + place.height, 2);
      }
    svg.rectangle({x, top, panel_width, panel_height}, "none", "#000000");
    draw_rays(svg, x);
  }

  static bool differ(const std::optional<Sign>& a, const std::optional<Sign>& b) {
    return a.has_value() != b.has_value() || (a && a->technique != b->technique);
  }

  [[nodiscard]] Rectangle place_of(double x, std::size_t i, std::size_t j) const {
    return {x + xs_[i], top + panel_height - ys_[j + 1], xs_[i + 1] - xs_[i], ys_[j + 1] - ys_[j]};
  }

  void draw_cell(Svg& svg, double x, std::size_t i, std::size_t j, const std::optional<Sign>& sign) const {
    const MapRow& row = map_.rows[j];
    const Rectangle place = place_of(x, i, j);
    const std::string where =
        fmt::format("{} rays, d = {}, X = {:.3g}: ", rays_label(map_.rays[i]), radius_label(row.given), row.x);
    if (!sign) return svg.rectangle(place, "#ffffff", "#bbbbbb", where + "unknown");
    const bool room_for_edges = std::min(place.width, place.height) > 8;
    svg.rectangle(place, colour_of(sign->technique), room_for_edges ? "#ffffff" : colour_of(sign->technique),
                  where + sign->tip);
    const double middle = place.x + place.width / 2;
    const double centre = place.y + place.height / 2;
    const std::string_view ink = text_colour_on(sign->technique);
    const bool room_for_code = place.width > 16 && place.height > 12;
    const bool room_for_seconds = sign->seconds && place.width > 36 && place.height > 25;
    if (room_for_code)
      svg.text(middle, centre + (room_for_seconds ? -1 : 4), code_of(sign->technique),
               {.size = text_size, .anchor = Anchor::middle, .fill = ink, .bold = true});
    if (room_for_seconds)
      svg.text(middle, centre + 10, seconds_label(*sign->seconds),
               {.size = small, .anchor = Anchor::middle, .fill = ink});
    if (sign->verdict && !sign->verdict->agrees)
      svg.corner(place.x + place.width - 1, place.y + 1, std::min({8.0, place.width / 2, place.height / 2}),
                 !sign->verdict->within_noise);
  }

  void draw_rays(Svg& svg, double x) const {
    const double axis = top + panel_height;
    double end = -left;  // of the last label
    for (std::size_t i = 0; i < map_.rays.size(); ++i) {
      const double middle = (xs_[i] + xs_[i + 1]) / 2;
      svg.line(x + middle, axis, x + middle, axis + 4);
      const std::string label = rays_label(map_.rays[i]);
      const double half = letter * text_size * static_cast<double>(label.size()) / 2;
      if (middle - half < end + 4) continue;
      end = middle + half;
      svg.text(x + middle, axis + 16, label, {.size = text_size, .anchor = Anchor::middle});
    }
    svg.text(x + panel_width / 2, axis + 34, "number of rays", {.size = text_size, .anchor = Anchor::middle});
  }

  /// Radii left of the panels, X right of them.
  void draw_radii(Svg& svg, double width) const {
    constexpr double room = 12;
    double last = -room;
    for (std::size_t j = 0; j < map_.rows.size(); ++j) {
      const MapRow& row = map_.rows[j];
      const double middle = (ys_[j] + ys_[j + 1]) / 2;
      const double y = top + panel_height - middle;
      svg.line(left - 4, y, left, y);
      svg.line(width - right, y, width - right + 4, y);
      if (middle - last < room) continue;
      last = middle;
      svg.text(left - 7, y + 4, radius_label(row.given), {.size = text_size, .anchor = Anchor::end});
      svg.text(width - right + 7, y + 4, fmt::format("{:.2g}", row.x), {.size = text_size});
    }
    const double middle = top + panel_height / 2;
    svg.text(18, middle, "disc radius d", {.size = text_size, .anchor = Anchor::middle, .upwards = true});
    svg.text(width - 12, middle, "X = distance between samples / d",
             {.size = text_size, .anchor = Anchor::middle, .upwards = true});
  }

  void draw_legend(Svg& svg, double y, std::size_t columns) const {
    for (std::size_t i = 0; i < present_.size(); ++i) {
      const double x = left + legend_column * static_cast<double>(i % columns);
      if (i > 0 && i % columns == 0) y += legend_line;
      svg.rectangle({x, y - 10, 24, 13}, colour_of(present_[i]), "#000000");
      svg.text(x + 12, y, code_of(present_[i]),
               {.size = small, .anchor = Anchor::middle, .fill = text_colour_on(present_[i])});
      svg.text(x + 30, y, name(present_[i]), {.size = text_size});
    }
    y += legend_line;
    if (agreement_.cells == 0) return;
    svg.corner(left + 20, y - 9, 8, true);
    svg.text(left + 30, y, "another technique than the predicted one is faster", {.size = text_size});
    svg.corner(left + 340, y - 9, 8, false);
    svg.text(left + 350, y, "the same, but within the noise of the measurement", {.size = text_size});
  }

  const TechniqueMap& map_;
  const std::string& machine_;
  const std::string& program_;
  Agreement agreement_;
  std::vector<double> xs_;  ///< edges of the cells, from the left
  std::vector<double> ys_;  ///< from the bottom
  std::vector<Panel> panels_;
  std::vector<Technique> present_;
};

}  // namespace

std::string map_svg(const TechniqueMap& map, const std::string& machine, const std::string& program) {
  if (map.rows.empty()) throw std::invalid_argument("a map without rows cannot be drawn");
  return MapDrawing(map, machine, program).draw();
}

}  // namespace detp::validate
