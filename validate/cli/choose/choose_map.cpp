#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "choose_text.hpp"
#include "detp/sim/files/output_file.hpp"
#include "detp/sim/files/table_writer.hpp"
#include "detp/validate/answer/parts.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "detp/validate/cli/options/cost_options.hpp"
#include "detp/validate/cli/report/answer_rows.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/cli/text/words.hpp"
#include "detp/validate/map/map_summary.hpp"
#include "detp/validate/picture/labels.hpp"

/// `choose --map`.
namespace detp::cli {
namespace {

using validate::MapCell;
using validate::MapRow;
using validate::PlacedCell;
using validate::TechniqueMap;

/// The lines of a table below its title, aligned right. `alike`: all columns are as wide as the widest.
TextBlock aligned(const std::string& title, const std::vector<std::vector<std::string>>& table, bool alike) {
  std::vector<std::size_t> widths(table.front().size());
  for (const auto& line : table)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], columns_of(line[i]));
  if (alike) std::ranges::fill(widths, std::ranges::max(widths));
  TextBlock block{{title}};
  for (const auto& line : table) {
    std::string& text = block.lines.emplace_back();
    for (std::size_t i = 0; i < line.size(); ++i) text += std::string(widths[i] - columns_of(line[i]), ' ') + line[i];
  }
  return block;
}

using CodeOf = std::function<std::string(const MapCell&)>;

/// Numbers of rays, and a line of codes for each disc radius, the largest first. Shows one of `every` numbers of rays.
TextBlock panel(const TechniqueMap& map, const std::string& title, const CodeOf& code_of, std::size_t every) {
  std::vector<std::vector<std::string>> table(1);
  for (std::size_t i = 0; i < map.rays.size(); i += every) table[0].push_back(validate::rays_label(map.rays[i]) + " ");
  for (auto row = map.rows.rbegin(); row != map.rows.rend(); ++row) {
    auto& line = table.emplace_back();
    for (std::size_t i = 0; i < row->cells.size(); i += every) line.push_back(code_of(row->cells[i]));
  }
  return aligned(title, table, true);
}

/// The disc radii and X.
TextBlock radii(const TechniqueMap& map) {
  std::vector<std::vector<std::string>> table{{"d", " X"}};
  for (auto row = map.rows.rbegin(); row != map.rows.rend(); ++row)
    table.push_back({validate::radius_label(row->given), fmt::format(" {:.2g}", row->x)});
  return aligned("", table, false);
}

std::string predicted_code(const MapCell& cell) {
  return cell.choice ? validate::code_of(cell.predicted()->technique) + " " : "- ";
}

std::string measured_code(const MapCell& cell) {
  const auto verdict = cell.verdict();
  if (!verdict) return "- ";
  return validate::code_of(cell.fastest()->candidate.technique) + (verdict->agrees         ? " "
                                                                   : verdict->within_noise ? "~"
                                                                                           : "!");
}

std::string paper_code(const MapCell& cell) { return validate::code_of(cell.paper.technique) + " "; }

std::vector<TextBlock> panels(const TechniqueMap& map, bool measured, bool paper, std::size_t every) {
  std::vector<TextBlock> blocks{radii(map), panel(map, "predicted", predicted_code, every)};
  if (measured) blocks.push_back(panel(map, "measured", measured_code, every));
  if (paper) blocks.push_back(panel(map, "paper's rule", paper_code, every));
  return blocks;
}

/// "bt box-tree, oc octree": the techniques that the map shows, with those of the paper's rule if `paper`.
std::string codes(const TechniqueMap& map, bool paper) {
  const auto shown = [&](Technique technique) {
    return std::ranges::any_of(map.cells(), [&](const PlacedCell& one) {
      const MapCell& cell = *one.cell;
      return (paper && cell.paper.technique == technique) ||
             (cell.choice && cell.predicted()->technique == technique) ||
             (cell.analysis && cell.fastest()->candidate.technique == technique);
    });
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
  const auto add = [&](const std::string& line) { text += paragraph(line, screen); };
  add(fmt::format("agree     the predicted technique was the fastest measured one in {} of {} cells ({:.0f} %)",
                  agreement.agree, agreement.cells, 100 * agreement.share()));
  add(
      fmt::format("slower    the predicted choice took {:.3f} times the shortest time in the geometric mean, {:.2f} at "
                  "worst",
                  agreement.mean_slowdown, agreement.worst_slowdown));
  for (std::size_t i = 0; i < std::min(shown, agreement.disagreeing.size()); ++i) {
    const PlacedCell& one = agreement.disagreeing[i];
    const validate::CellVerdict verdict = *one.cell->verdict();
    add(fmt::format("differs   {} rays, d = {}: {} took {} {}{}", validate::rays_label(one.cell->rays),
                    validate::radius_label(one.row->given), title(one.cell->analysis->candidates.front().candidate),
                    times_text(verdict.slower), title(one.cell->fastest()->candidate),
                    verdict.within_noise ? ", within noise" : ""));
  }
  if (agreement.disagreeing.size() > shown)
    add(fmt::format("          and {} cells more; {} of all {} within noise", agreement.disagreeing.size() - shown,
                    agreement.within_noise(), agreement.disagreeing.size()));
  return text;
}

/// In how many cells the paper's rule takes the technique that is fastest: measured, or predicted if nothing was
/// measured.
std::string paper_line(const TechniqueMap& map, bool measured) {
  std::size_t cells = 0;
  std::size_t same = 0;
  for (const PlacedCell& one : map.cells()) {
    const Candidate* const first = !measured            ? one.cell->predicted()
                                   : one.cell->analysis ? &one.cell->fastest()->candidate
                                                        : nullptr;
    if (first == nullptr) continue;
    ++cells;
    same += one.cell->paper.technique == first->technique ? 1 : 0;
  }
  return fmt::format("paper     its rule takes the technique that is {} fastest in {} of {} cells",
                     measured ? "measured" : "predicted", same, cells);
}

/// Maps of characters, side by side as far as they fit the screen, and how predicted and measured techniques agree. `verbose`: also
/// the map of the paper's rule, the cells that disagree, and how long it took.
std::string to_text(const TechniqueMap& map, const Screen& screen, bool verbose) {
  if (map.rows.empty()) return "nothing is known yet\n";
  const validate::Agreement agreement = validate::agreement_of(map);
  const bool measured = agreement.cells > 0;
  std::string text = paragraph("map       " + describe(map), screen);
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
    if (measured) text += paragraph(agreement_line(agreement), screen);
    return text;
  }
  text += legend(screen, codes(map, true) +
                             ": the fastest technique for each number of rays. d: disc radius. X: distance between "
                             "neighbouring samples over d." +
                             marks) +
          "\n";
  if (measured) text += agreement_lines(agreement, screen);
  std::string took = fmt::format("took      {:.2g} s for scenes, rays and predictions", map.predicting_seconds);
  if (measured) took += fmt::format(", {:.3g} s for measurements", map.measuring_seconds);
  return text + paragraph(paper_line(map, measured), screen) + paragraph(took, screen);
}

Json map_inputs(const validate::MapRequest& request, const TechniqueMap& map) {
  Json json{{"map", true}};
  json.update(origin_json(request.job, map.name, map.field));
  json["rays"] = Json::array();
  for (const double rays : map.rays) json["rays"].push_back(whole(rays));
  json["disc_radius"] = Json::array();
  json["sphere_radius"] = Json::array();
  for (const MapRow& row : map.rows) {
    json["disc_radius"].push_back(row.workload.disc_radius);
    json["sphere_radius"].push_back(row.workload.sphere_radius);
  }
  if (!map.rows.empty()) {
    json["samples"] = whole(map.rows.front().workload.samples);
    json["dimension"] = map.rows.front().workload.dimension;
    json["scene_side"] = scene_side(map.rows.front().workload);
  }
  json["engine"] = name(request.costs.engine);
  json["analyze"] = request.measure;
  json["rigor"] = request.rigor ? Json(name(*request.rigor)) : Json("auto");
  json["disabled"] = names_json(request.disabled);
  json["unit_costs"] = to_json(request.costs);
  return json;
}

/// A row for each cell. The columns that are the same for all cells come from the resolved inputs.
std::string to_csv(const TechniqueMap& map, const Json& inputs) {
  Table table(workload_columns() + columns_of(validate::map_cell_fields()));
  Json shared;
  for (const char* key : {"scene", "field", "ray_file", "front_facing", "seed"})
    if (inputs.contains(key)) shared[key] = inputs[key];
  for (const PlacedCell& one : map.cells()) {
    Json cells = shared;
    cells.update(workload_cells(to_json(one.row->workload)));
    cells["rays"] = whole(one.cell->rays);
    cells.update(cells_of(validate::map_cell_fields(), one));
    table.add(cells);
  }
  return table.csv();
}

void write_picture(const std::string& path, const std::string& svg, const std::stop_token& stop) {
  sim::OutputFile file(path, stop);
  file.write(svg);
  file.commit();
}

}  // namespace

Result run_choose_map(const validate::MapRequest& request, const CommonOptions& common, bool verbose,
                      const std::stop_token& stop) {
  const ProgressLine progress(common.quiet);
  const TechniqueMap map = validate::answer(request, stop, progress.report());
  for (const std::string& notice : map.notices) note(common, notice);
  for (const std::string& warning : map.warnings) note(common, "warning: " + warning);
  Result result;
  result.schema = "choose-map";
  const bool picture = common.output && sim::suffix_of(*common.output) == ".svg";
  if (picture && !map.rows.empty())
    write_picture(*common.output, validate::map_svg(map, validate::this_machine().cpu, "detp " DETP_VERSION), stop);
  result.output_is_written = picture;
  result.inputs = map_inputs(request, map);
  result.json = json_of(validate::map_fields(), map);
  result.csv = to_csv(map, result.inputs);
  CommonOptions shown = common;
  if (picture) shown.output.reset();  // the text goes to stdout
  const Screen screen = shown.screen();
  result.text = to_text(map, screen, verbose) + paragraph("costs     " + map.costs_origin, screen);
  if (picture)
    result.text +=
        paragraph(map.rows.empty() ? "picture   none: nothing is known yet" : "picture   " + *common.output, screen);
  result.stopped = map.stopped;
  return result;
}

}  // namespace detp::cli
