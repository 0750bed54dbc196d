#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "choose_map.hpp"
#include "detp/validate/cli/text/screen.hpp"
#include "detp/validate/cli/text/words.hpp"
#include "detp/validate/map/map_summary.hpp"
#include "detp/validate/picture/labels.hpp"

namespace detp::cli {
namespace {

using validate::MapCell;
using validate::MapRow;

std::string aligned_right(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, columns_of(text)), ' ') + text;
}

using CodeOf = std::function<std::string(const MapCell&)>;

/// A title, numbers of rays, and a line of codes for each disc radius, the largest first. Shows one of `every` numbers
/// of rays.
TextBlock panel(const validate::TechniqueMap& map, const std::string& title, const CodeOf& code_of, std::size_t every) {
  std::vector<std::vector<std::string>> table(1);
  for (std::size_t i = 0; i < map.rays.size(); i += every) table[0].push_back(validate::rays_label(map.rays[i]) + " ");
  for (auto row = map.rows.rbegin(); row != map.rows.rend(); ++row) {
    auto& line = table.emplace_back();
    for (std::size_t i = 0; i < row->cells.size(); i += every) line.push_back(code_of(row->cells[i]));
  }
  std::size_t widest = 0;
  for (const auto& line : table)
    for (const std::string& text : line) widest = std::max(widest, columns_of(text));
  TextBlock block{{title}};
  for (const auto& line : table) {
    std::string& text = block.lines.emplace_back();
    for (const std::string& one : line) text += aligned_right(one, widest);
  }
  return block;
}

/// The disc radii and X.
TextBlock radii(const validate::TechniqueMap& map) {
  std::vector<std::pair<std::string, std::string>> table{{"d", "X"}};
  for (auto row = map.rows.rbegin(); row != map.rows.rend(); ++row)
    table.emplace_back(validate::radius_label(row->given), fmt::format("{:.2g}", row->x));
  std::size_t first = 0;
  std::size_t second = 0;
  for (const auto& [d, x] : table) {
    first = std::max(first, columns_of(d));
    second = std::max(second, columns_of(x));
  }
  TextBlock block{{""}};
  for (const auto& [d, x] : table) block.lines.push_back(aligned_right(d, first) + aligned_right(x, second + 1));
  return block;
}

std::string predicted_code(const MapCell& cell) {
  return cell.choice ? validate::code_of(cell.choice->best().candidate.technique) + " " : "- ";
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

std::vector<TextBlock> panels(const validate::TechniqueMap& map, bool measured, bool paper, std::size_t every) {
  std::vector<TextBlock> blocks{radii(map), panel(map, "predicted", predicted_code, every)};
  if (measured) blocks.push_back(panel(map, "measured", measured_code, every));
  if (paper) blocks.push_back(panel(map, "paper's rule", paper_code, every));
  return blocks;
}

/// "bt box-tree, oc octree": the techniques that the map shows, with those of the paper's rule if `paper`.
std::string codes(const validate::TechniqueMap& map, bool paper) {
  const auto shown = [&](Technique technique) {
    for (const MapRow& row : map.rows)
      for (const MapCell& cell : row.cells)
        if ((paper && cell.paper.technique == technique) ||
            (cell.choice && cell.choice->best().candidate.technique == technique) ||
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

/// In how many cells the prediction was right, and how much slower its choices are.
std::string agreement_line(const validate::Agreement& agreement) {
  return fmt::format(
      "agree     the predicted technique was the fastest measured one in {} of {} cells ({:.0f} %); the predicted "
      "choice took {} in "
      "the geometric mean, {} at worst",
      agreement.agree, agreement.cells, 100 * agreement.share(), as_long(agreement.mean_slowdown),
      as_long(agreement.worst_slowdown, "the fastest"));
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
      if (measured ? !cell.analysis.has_value() : !cell.choice.has_value()) continue;
      ++cells;
      const Candidate& first = measured ? fastest(cell) : cell.choice->best().candidate;
      same += cell.paper.technique == first.technique ? 1 : 0;
    }
  return fmt::format("paper     its rule takes the technique that is {} fastest in {} of {} cells",
                     measured ? "measured" : "predicted", same, cells);
}

}  // namespace

std::string to_text(const validate::TechniqueMap& map, const Screen& screen, bool verbose) {
  if (map.rows.empty()) return "nothing is known yet\n";
  const validate::Agreement agreement = validate::agreement_of(map);
  const bool measured = agreement.cells > 0;
  std::string text = wrapped("map       " + validate::describe(map), screen.text_width(), 10);
  const auto add = [&](const std::string& line) { text += wrapped(line, screen.text_width(), 10); };
  if (verbose) text += "\n";
  std::size_t every = 1;
  std::vector<TextBlock> blocks = panels(map, measured, verbose, every);
  while (is_too_wide(blocks, screen) && every < map.rays.size()) blocks = panels(map, measured, verbose, ++every);
  text += side_by_side(blocks, screen);
  if (!verbose) text.pop_back();  // the empty line below the panels
  if (every > 1)
    text += wrapped(fmt::format("(one of {} numbers of rays; --format csv or a wider terminal shows all)", every),
                    screen.text_width(), 1);
  const std::string marks = measured ? " !: another technique than the predicted one. ~: the same, within the noise of "
                                       "the measurement. -: not measured."
                                     : "";
  if (!verbose) {
    text += legend(screen, codes(map, false) + ": the fastest technique, by number of rays and disc radius d." + marks);
    if (measured) add(agreement_line(agreement));
    return text;
  }
  text += legend(screen, codes(map, true) +
                             ": the fastest technique for each number of rays. d: disc radius. X: distance between "
                             "neighbouring samples over d." +
                             marks) +
          "\n";
  if (measured) text += agreement_lines(agreement, screen);
  add(paper_line(map, measured));
  std::string took = fmt::format("took      {:.2g} s for scenes, rays and predictions", map.predicting_seconds);
  if (measured) took += fmt::format(", {:.3g} s for measurements", map.measuring_seconds);
  add(took);
  return text;
}

}  // namespace detp::cli
