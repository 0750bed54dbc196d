#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "choose_map_report.hpp"
#include "detp/validate/map/agreement.hpp"
#include "detp/validate/map/map_labels.hpp"
#include "detp/validate/map/technique_sign.hpp"

namespace detp::cli {
namespace {

using validate::MapCell;
using validate::MapRow;

/// Lines of the same width.
struct Block {
  std::size_t width = 0;
  std::vector<std::string> lines;  ///< a title, a head, and a line for each disc radius, the largest first
};

std::string aligned_right(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, columns_of(text)), ' ') + text;
}

using CodeOf = std::function<std::string(const MapCell&)>;

Block panel(const validate::TechniqueMap& map, const std::string& title, const CodeOf& code_of) {
  std::vector<std::vector<std::string>> lines(1);
  for (const double rays : map.rays) lines[0].push_back(validate::rays_label(rays));
  for (auto row = map.rows.rbegin(); row != map.rows.rend(); ++row) {
    auto& line = lines.emplace_back();
    for (const MapCell& cell : row->cells) line.push_back(code_of(cell));
  }
  std::size_t widest = 3;
  for (const auto& line : lines)
    for (const std::string& text : line) widest = std::max(widest, columns_of(text));
  Block block{std::max(columns_of(title), map.rays.size() * (widest + 1)), {title}};
  for (const auto& line : lines) {
    std::string& text = block.lines.emplace_back();
    for (const std::string& one : line) text += aligned_right(one, widest + 1);
  }
  return block;
}

/// The disc radii and X.
Block radii(const validate::TechniqueMap& map) {
  constexpr std::size_t width = 7;
  Block block{2 * width, {"", aligned_right("d", width) + aligned_right("X", width)}};
  for (auto row = map.rows.rbegin(); row != map.rows.rend(); ++row)
    block.lines.push_back(aligned_right(validate::radius_label(row->given), width) +
                          aligned_right(fmt::format("{:.2g}", row->x), width));
  return block;
}

/// The blocks side by side, the first one again wherever a new line of blocks begins.
std::string side_by_side(const std::vector<Block>& blocks, const Screen& screen) {
  constexpr std::size_t gap = 2;
  std::string text;
  for (std::size_t next = 1; next < blocks.size();) {
    std::vector<const Block*> shown{&blocks.front(), &blocks[next++]};
    std::size_t width = shown[0]->width + gap + shown[1]->width;
    while (next < blocks.size() && (screen.width == 0 || width + gap + blocks[next].width <= screen.width)) {
      width += gap + blocks[next].width;
      shown.push_back(&blocks[next++]);
    }
    for (std::size_t i = 0; i < blocks.front().lines.size(); ++i) {
      std::string line;
      for (const Block* block : shown) {
        line += (line.empty() ? "" : std::string(gap, ' ')) + block->lines[i];
        line.resize(line.size() + block->width - std::min(block->width, columns_of(block->lines[i])), ' ');
      }
      line.erase(line.find_last_not_of(' ') + 1);
      text += line + "\n";
    }
    text += "\n";
  }
  return text;
}

std::string predicted_code(const MapCell& cell) {
  return cell.prediction ? validate::code_of(cell.prediction->choice().candidate.technique) + " " : "- ";
}

const Candidate& fastest(const MapCell& cell) {
  return cell.analysis->candidates[cell.analysis->best.value()].candidate;
}

std::string measured_code(const MapCell& cell) {
  if (!cell.analysis) return "- ";
  const validate::CellVerdict verdict = validate::verdict_of(cell);
  return validate::code_of(fastest(cell).technique) + (verdict.agrees ? " " : verdict.within_noise ? "~" : "!");
}

std::string paper_code(const MapCell& cell) { return validate::code_of(cell.paper.technique) + " "; }

/// "bt box-tree, oc octree": the techniques that the map shows.
std::string codes(const validate::TechniqueMap& map) {
  const auto shown = [&](Technique technique) {
    for (const MapRow& row : map.rows)
      for (const MapCell& cell : row.cells)
        if (cell.paper.technique == technique ||
            (cell.prediction && cell.prediction->choice().candidate.technique == technique) ||
            (cell.analysis && fastest(cell).technique == technique))
          return true;
    return false;
  };
  std::string list;
  for (const Technique technique : all_techniques)
    if (shown(technique))
      list += fmt::format("{}{} {}", list.empty() ? "" : ", ", validate::code_of(technique), name(technique));
  return list;
}

std::string times_text(double slower) {
  return slower < 1 ? fmt::format("{:.2g} % longer than", 100 * slower)
                    : fmt::format("{:.3g} times as long as", 1 + slower);
}

std::string agreement_lines(const validate::Agreement& agreement, const Screen& screen) {
  constexpr std::size_t shown = 5;
  std::string text;
  const auto add = [&](const std::string& line) { text += wrapped(line, screen.text_width(), 10); };
  add(fmt::format("agree     the predicted technique was the fastest measured one in {} of {} cells ({:.0f} %)",
                  agreement.agree, agreement.cells, 100 * agreement.share()));
  add(
      fmt::format("slower    the predicted choice took {:.3f} times the shortest time in the geometric mean, {:.2f} at "
                  "worst",
                  agreement.mean_slowdown, agreement.worst_slowdown));
  for (std::size_t i = 0; i < std::min(shown, agreement.disagreeing.size()); ++i) {
    const validate::Disagreement& one = agreement.disagreeing[i];
    add(fmt::format("differs   {} rays, d = {}: {} took {} {}{}", validate::rays_label(one.cell->rays),
                    validate::radius_label(one.row->given), title(one.cell->analysis->candidates.front().candidate),
                    times_text(one.verdict.slower), title(fastest(*one.cell)),
                    one.verdict.within_noise ? ", within noise" : ""));
  }
  if (agreement.disagreeing.size() > shown)
    add(fmt::format("          and {} cells more; {} of all {} within noise", agreement.disagreeing.size() - shown,
                    agreement.within_noise(), agreement.disagreeing.size()));
  return text;
}

/// In how many cells the paper's rule takes the technique that is fastest: measured, or predicted if nothing was
/// measured.
std::string paper_line(const validate::TechniqueMap& map, bool measured) {
  std::size_t cells = 0;
  std::size_t same = 0;
  for (const MapRow& row : map.rows)
    for (const MapCell& cell : row.cells) {
      if (measured ? !cell.analysis.has_value() : !cell.prediction.has_value()) continue;
      ++cells;
      const Candidate& first = measured ? fastest(cell) : cell.prediction->choice().candidate;
      same += cell.paper.technique == first.technique ? 1 : 0;
    }
  return fmt::format("paper     its rule takes the technique that is {} fastest in {} of {} cells",
                     measured ? "measured" : "predicted", same, cells);
}

}  // namespace

std::string to_text(const validate::TechniqueMap& map, const Screen& screen) {
  if (map.rows.empty()) return "nothing is known yet\n";
  const validate::Agreement agreement = validate::agreement_of(map);
  const bool measured = agreement.cells > 0;
  std::string text = wrapped("map       " + validate::describe(map), screen.text_width(), 10) + "\n";
  std::vector<Block> blocks{radii(map), panel(map, " predicted fastest, by rays", predicted_code)};
  if (measured) blocks.push_back(panel(map, " measured fastest", measured_code));
  blocks.push_back(panel(map, " paper's rule", paper_code));
  text += side_by_side(blocks, screen);
  text += legend(screen, codes(map) + ". d: disc radius. X: distance between neighbouring samples over d." +
                             (measured ? " !: another technique than the predicted one. ~: the same, within the noise "
                                         "of the measurement. -: not measured."
                                       : "")) +
          "\n";
  if (measured) text += agreement_lines(agreement, screen);
  const auto add = [&](const std::string& line) { text += wrapped(line, screen.text_width(), 10); };
  add(paper_line(map, measured));
  std::string took = fmt::format("took      {:.2g} s for scenes, rays and predictions", map.predicting_seconds);
  if (measured) took += fmt::format(", {:.3g} s for measurements", map.measuring_seconds);
  add(took);
  return text;
}

}  // namespace detp::cli
