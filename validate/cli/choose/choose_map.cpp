#include "choose_map.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "detp/sim/files/file_suffix.hpp"
#include "detp/sim/files/output_file.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "detp/validate/cli/options/cost_options.hpp"
#include "detp/validate/cli/report/answer_rows.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/cli/text/table.hpp"
#include "detp/validate/map/map_summary.hpp"
#include "detp/validate/map/map_svg.hpp"

namespace detp::cli {
namespace {

using validate::MapCell;
using validate::MapRow;

Json named_json(const Candidate& candidate) {
  return {{"technique", name(candidate.technique)}, {"parameters", to_json(candidate)}};
}

/// The techniques' best candidates: of these, the first of each technique.
template <class Candidates, class Seconds>
Json best_of_each(const Candidates& candidates, const Seconds& seconds) {
  Json best = Json::array();
  for (const auto& one : candidates) {
    if (!seconds(one)) continue;
    const auto same = std::find_if(best.begin(), best.end(), [&](const Json& other) {
      return other["technique"] == name(one.candidate.technique);
    });
    Json json = named_json(one.candidate);
    json["seconds"] = *seconds(one);
    if (same == best.end())
      best.push_back(std::move(json));
    else if ((*same)["seconds"] > json["seconds"])
      *same = std::move(json);
  }
  return best;
}

Json predicted_json(const validate::Choice& choice) {
  Json json = named_json(choice.best().candidate);
  json["seconds"] = choice.best().time.total();
  if (choice.rigor == Rigor::pilot) json["seconds_error"] = choice.best().error;
  json["rigor"] = name(choice.rigor);
  json["techniques"] =
      best_of_each(choice.candidates, [](const Prediction& one) { return std::optional(one.time.total()); });
  for (const validate::RuledOut& one : choice.ruled_out)
    json["techniques"].push_back(
        {{"technique", name(one.technique)}, {one.by_bound ? "at_least_seconds" : "seconds", one.seconds}});
  return json;
}

Json measured_json(const validate::Analysis& analysis) {
  const validate::Analysed& best = analysis.candidates[analysis.best.value()];
  const validate::Analysed& choice = analysis.candidates.front();
  Json json = named_json(best.candidate);
  json["seconds"] = best.seconds.value();
  json["spread"] = best.spread;
  json["predicted_choice_seconds"] = choice.seconds.value();
  json["predicted_choice_spread"] = choice.spread;
  json["tried"] = analysis.tried;
  json["techniques"] = best_of_each(analysis.candidates, [](const validate::Analysed& one) { return one.seconds; });
  return json;
}

Json cell_json(const MapRow& row, const MapCell& cell) {
  Json json{{"rays", whole(cell.rays)}, {"disc_radius", row.workload.disc_radius}, {"x", row.x}};
  if (cell.choice) json["predicted"] = predicted_json(*cell.choice);
  json["paper_rule"] = named_json(cell.paper);
  if (!cell.analysis) return json;
  const validate::CellVerdict verdict = validate::verdict_of(cell);
  json["measured"] = measured_json(*cell.analysis);
  json["agrees"] = verdict.agrees;
  json["slower"] = verdict.slower;
  json["within_noise"] = verdict.within_noise;
  return json;
}

Json agreement_json(const validate::Agreement& agreement) {
  return {{"cells", agreement.cells},
          {"agree", agreement.agree},
          {"share", agreement.share()},
          {"disagree_within_noise", agreement.within_noise()},
          {"slowdown", {{"geometric_mean", agreement.mean_slowdown}, {"worst", agreement.worst_slowdown}}}};
}

Json csv_row(const MapRow& row, const MapCell& cell) {
  const Json json = cell_json(row, cell);
  Json cells{{"x", row.x}};
  cells.update(to_json(row.workload));
  cells.erase("box");
  cells["rays"] = whole(cell.rays);
  const auto add = [&](const std::string& prefix, const Candidate& candidate) {
    cells[prefix + "technique"] = name(candidate.technique);
    cells[prefix + "parameters"] = describe(candidate);
  };
  add("paper_", cell.paper);
  if (cell.choice) {
    add("predicted_", cell.choice->best().candidate);
    cells["predicted_seconds"] = json["predicted"]["seconds"];
    if (json["predicted"].contains("seconds_error"))
      cells["predicted_seconds_error"] = json["predicted"]["seconds_error"];
    cells["rigor"] = json["predicted"]["rigor"];
  }
  if (!cell.analysis) return cells;
  add("measured_", cell.analysis->candidates[*cell.analysis->best].candidate);
  cells["measured_seconds"] = json["measured"]["seconds"];
  cells["measured_spread"] = json["measured"]["spread"];
  cells["predicted_choice_measured_seconds"] = json["measured"]["predicted_choice_seconds"];
  for (const char* key : {"agrees", "slower", "within_noise"}) cells[key] = json[key];
  return cells;
}

}  // namespace

Json to_json(const validate::TechniqueMap& map) {
  Json json{{"axes", {{"rays", Json::array()}, {"disc_radius", Json::array()}, {"x", Json::array()}}},
            {"cells", Json::array()}};
  for (const double rays : map.rays) json["axes"]["rays"].push_back(whole(rays));
  for (const MapRow& row : map.rows) {
    json["axes"]["disc_radius"].push_back(row.workload.disc_radius);
    json["axes"]["x"].push_back(row.x);
    for (const MapCell& cell : row.cells) json["cells"].push_back(cell_json(row, cell));
  }
  if (const validate::Agreement agreement = validate::agreement_of(map); agreement.cells > 0)
    json["agreement"] = agreement_json(agreement);
  json["warnings"] = map.warnings;
  json["seconds"] = {{"predicting", map.predicting_seconds}, {"measuring", map.measuring_seconds}};
  return json;
}

std::string to_csv(const validate::TechniqueMap& map, const Json& inputs) {
  Table table(workload_columns() + Columns{"x", "predicted_technique", "predicted_parameters", "predicted_seconds",
                                           "predicted_seconds_error", "rigor", "measured_technique",
                                           "measured_parameters", "measured_seconds", "measured_spread",
                                           "predicted_choice_measured_seconds", "slower", "within_noise", "agrees",
                                           "paper_technique", "paper_parameters"});
  Json shared;
  for (const char* key : {"scene", "field", "ray_file", "front_facing", "seed"})
    if (inputs.contains(key)) shared[key] = inputs[key];
  for (const MapRow& row : map.rows)
    for (const MapCell& cell : row.cells) {
      Json cells = shared;
      cells.update(csv_row(row, cell));
      table.add(cells);
    }
  return table.csv();
}

namespace {

/// The values of --rays and --disc-radius. Where there are none: the default ones, or none if a file decides.
validate::MapAxes map_axes(WorkloadOptions& workload, const CommonOptions& common) {
  validate::MapAxes axes;
  bool own_rays = false;
  bool own_radii = false;
  for (std::size_t row = 0; row < workload.lists.rows(); ++row) {
    workload.lists.choose_row(row);
    const validate::JobRequest request = workload.request(common, false);
    own_rays = request.ray_file.has_value();
    own_radii = request.disc_file.has_value();
    if (request.rays) axes.rays.push_back(*request.rays);
    if (request.disc_radius) axes.radii.push_back(*request.disc_radius);
  }
  if (axes.rays.empty() && !own_rays) axes.rays = validate::default_map_rays();
  if (axes.radii.empty() && !own_radii) axes.radii = validate::default_map_radii();
  return validate::checked(std::move(axes));
}

Json map_inputs(const ChooseMap& command, const validate::JobRequest& request, const validate::TechniqueMap& map,
                const CostTable& costs) {
  Json json{{"map", true}};
  json.update(origin_json(request, map.name, map.field));
  json["rays"] = Json::array();
  for (const double rays : map.rays) json["rays"].push_back(whole(rays));
  json["disc_radius"] = Json::array();
  json["sphere_radius"] = Json::array();
  for (const validate::MapRow& row : map.rows) {
    json["disc_radius"].push_back(row.workload.disc_radius);
    json["sphere_radius"].push_back(row.workload.sphere_radius);
  }
  if (!map.rows.empty()) {
    json["samples"] = whole(map.rows.front().workload.samples);
    json["dimension"] = map.rows.front().workload.dimension;
    json["scene_side"] = scene_side(map.rows.front().workload);
  }
  json["engine"] = name(command.engine);
  json["analyze"] = command.analyze;
  json["rigor"] = command.rigor ? Json(name(*command.rigor)) : Json("auto");
  json["disabled"] = names_json(command.disabled);
  json["unit_costs"] = to_json(costs);
  return json;
}

void write_picture(const std::string& path, const std::string& svg, const std::stop_token& stop) {
  sim::OutputFile file(path, stop);
  file.write(svg);
  file.commit();
}

}  // namespace

Result run_choose_map(const ChooseMap& command, const CommonOptions& common, const std::stop_token& stop) {
  const validate::MapAxes axes = map_axes(command.workload, common);
  validate::JobRequest request = command.workload.request(common, false);
  if (!axes.radii.empty()) request.disc_radius = axes.radii.front();
  if (request.numbers_alone()) require_numbers(request);
  const CostsInUse costs = command.costs.costs(common);
  note_doubt(costs, common);
  const ProgressLine progress(common.quiet);
  const validate::TechniqueMap map = validate::make_map(request, axes,
                                                        {.costs = costs.of(command.engine),
                                                         .rigor = command.rigor,
                                                         .measure = command.analyze,
                                                         .threads = common.threads,
                                                         .disabled = command.disabled,
                                                         .checkpoint = command.checkpoint,
                                                         .resume = command.resume,
                                                         .stop = stop,
                                                         .progress = progress.report()});
  for (const std::string& notice : map.notices) note(common, notice);
  for (const std::string& warning : map.warnings) note(common, "warning: " + warning);
  Result result;
  result.schema = "choose-map";
  const bool picture = common.output && sim::suffix_of(*common.output) == ".svg";
  if (picture && !map.rows.empty())
    write_picture(*common.output,
                  validate::map_svg(map, {validate::this_machine().cpu, "detp " DETP_VERSION, costs.origin}), stop);
  result.output_is_written = picture;
  result.inputs = map_inputs(command, request, map, costs.of(command.engine));
  result.json = to_json(map);
  result.json["unit_costs"] = costs.origin;
  result.csv = to_csv(map, result.inputs);
  CommonOptions shown = common;
  if (picture) shown.output.reset();  // the text goes to stdout
  const Screen screen = shown.screen();
  result.text = to_text(map, screen, command.verbose);
  const auto add = [&](const std::string& line) { result.text += wrapped(line, screen.text_width(), 10); };
  add("costs     " + costs.origin);
  if (picture) add(map.rows.empty() ? "picture   none: nothing is known yet" : "picture   " + *common.output);
  result.stopped = map.stopped;
  return result;
}

}  // namespace detp::cli
