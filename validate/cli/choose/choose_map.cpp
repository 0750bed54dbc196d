#include "choose_map.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "choose_map_report.hpp"
#include "detp/sim/files/file_suffix.hpp"
#include "detp/sim/files/output_file.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "detp/validate/cli/options/unit_cost_option.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/map/map_svg.hpp"

namespace detp::cli {
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
