#include "parts.hpp"

#include <algorithm>

namespace detp::validate {
namespace {

Json lights_json(const std::vector<sim::Light>& lights) {
  Json json = Json::array();
  for (const sim::Light& light : lights) json.push_back({{"kind", name(sim::kind_of(light))}, {"flux", light.flux}});
  return json;
}

std::string column_of(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

}  // namespace

std::string_view name(sim::Field field) {
  if (field == sim::Field::mixed) return "mixed";
  return field == sim::Field::isotropic ? "isotropic" : "photons";
}

Json names_json(const std::vector<Technique>& techniques) {
  Json names = Json::array();
  for (const Technique technique : techniques) names.push_back(name(technique));
  return names;
}

Json to_json(const Workload& workload) {
  return {{"rays", whole(workload.rays)},
          {"samples", whole(workload.samples)},
          {"disc_radius", workload.disc_radius},
          {"sphere_radius", workload.sphere_radius},
          {"scene_side", scene_side(workload)},
          {"box", workload.box},
          {"dimension", workload.dimension},
          {"sample_extent", sample_extent(workload)},
          {"sample_distance", sample_distance(workload)},
          {"path_length", workload.path_length}};
}

Json numbers_json(const Workload& workload) {
  Json json{{"scene", name_of_numbers(workload)},
            {"field", name(sim::Field::isotropic)},
            {"front_facing", workload.front_facing}};
  json.update(to_json(workload));
  return json;
}

Json origin_json(const JobRequest& request, const std::string& scene, sim::Field field) {
  Json json{{"scene", scene}};
  if (request.disc_file) json["discs"] = *request.disc_file;
  if (request.ray_file)
    json["ray_file"] = *request.ray_file;
  else if (!request.without_rays)
    json["field"] = name(field);
  if (request.rgb) json["bands"] = "rgb";
  for (const sim::BandColumn& band : request.bands) json["bands"][band.name] = band.column;
  for (const sim::ColumnName& one : request.columns)
    json["columns"][one.name] = (one.opposite ? "-" : "") + one.heading;
  if (request.landed) json["landed"] = true;
  if (request.crease) json["crease"] = *request.crease;
  json["front_facing"] = request.front_facing;
  if (request.second_intersection) json["second_intersection"] = true;
  json["seed"] = request.seed;
  return json;
}

Json to_json(const Job& job, const JobRequest& request) {
  Json json = origin_json(request, job.name, job.field);
  if (job.field == sim::Field::mixed && !request.ray_file)
    json["shares"] = {{"isotropic", request.shares.isotropic},
                      {"directional", request.shares.directional},
                      {"point", request.shares.point}};
  if (!job.lights.empty() && job.field == sim::Field::photons && !request.ray_file) {
    json["light"] = lights_json(job.lights);
    json["up"] = sim::name(job.up);
  }
  json.update(to_json(job.workload()));
  return json;
}

Json light_json(const sim::LightLedger& light) {
  using enum sim::PathEnd;
  const auto photons = [&](sim::PathEnd end) { return light.photons[static_cast<std::size_t>(end)]; };
  Json json{{"photons", light.all_photons()},
            {"absorbed", photons(absorbed)},
            {"left", photons(left) + photons(missed)},
            {"cut", photons(cut)},
            {"absorbed_share", light.share(absorbed)},
            {"left_share", light.share(left) + light.share(missed)},
            {"cut_share", light.share(cut)},
            {"landings", static_cast<double>(light.landings) / static_cast<double>(light.all_photons())}};
  for (std::size_t band = 0; band < light.bands.size(); ++band)
    if (const sim::BandLedger& one = light.bands[band]; one.emitted > 0)
      json["bands"][std::string(1, "rgb"[band])] = {{"absorbed_share", one.deposited / one.emitted},
                                                    {"left_share", one.left / one.emitted},
                                                    {"cut_share", one.cut / one.emitted}};
  return json;
}

Json geometry_json(const sim::PolygonCounts& polygons, std::uint64_t normals_made, std::uint64_t coincident) {
  return {{"polygons_split", polygons.split},
          {"not_plane", polygons.not_plane},
          {"degenerate", polygons.degenerate},
          {"coincident", coincident},
          {"normals_made", normals_made}};
}

Json ledgers_json(const Job& job) {
  Json json = Json::object();
  if (job.light) json["light"] = light_json(*job.light);
  if (job.triangles > 0) json["geometry"] = geometry_json(job.polygons, job.normals_made, job.coincident);
  return json;
}

Json to_json(const std::vector<sim::EffectReport>& effects) {
  Json json = Json::array();
  for (const sim::EffectReport& report : effects)
    json.push_back({{"name", report.effect->name},
                    {"on", report.on},
                    {"value", report.value},
                    {"standard_error", report.standard_error},
                    {"threshold", report.effect->threshold.at},
                    {"on_if", sim::condition(report.effect->threshold)},
                    {"over_threshold", report.effect->threshold.over(report.value)},
                    {"close", report.is_close()},
                    {"seconds", report.seconds},
                    {"evidence", report.effect->evidence},
                    {"reason", report.reason}});
  return json;
}

const Columns& effect_columns() {
  static const Columns columns = [] {
    Columns all;
    for (const sim::Effect* effect : sim::all_effects) {
      all.push_back(column_of(std::string(effect->name)));
      all.push_back(all.back() + "_value");
    }
    return all;
  }();
  return columns;
}

Json effect_cells(const Json& effects) {
  Json cells = Json::object();
  for (const Json& effect : effects) {
    const std::string column = column_of(effect["name"]);
    cells[column] = effect["on"];
    cells[column + "_value"] = effect["value"];
  }
  return cells;
}

const Columns& workload_columns() {
  static const Columns columns{
      "scene", "field",         "rays",       "samples",   "disc_radius",   "ray_file",        "front_facing",
      "seed",  "sphere_radius", "scene_side", "dimension", "sample_extent", "sample_distance", "path_length"};
  return columns;
}

const Fields<Candidate>& candidate_fields() {
  static const Fields<Candidate> fields = [] {
    std::vector<Column> parameters;
    for (const Technique technique : all_techniques) {
      const Json of_one = to_json(default_candidate(technique));
      for (const auto& [parameter, value] : of_one.items())
        if (std::ranges::find(parameters, parameter, &Column::name) == parameters.end())
          parameters.push_back({parameter, "/" + parameter});
    }
    using Of = Field<Candidate>;
    return Fields<Candidate>{
        Of("technique", "", "name of the technique", [](const Candidate& one) { return name(one.technique); }),
        Of("parameters", "", "its parameters in words", [](const Candidate& one) { return describe(one); })
            .in_tables_alone(),
        Of("parameters", "", "its parameters by name", [](const Candidate& one) {
          return to_json(one);
        }).in(std::move(parameters))};
  }();
  return fields;
}

const Columns& candidate_columns() {
  static const Columns columns = columns_of(candidate_fields());
  return columns;
}

std::vector<Column> parameter_columns(const Columns& more) {
  std::vector<Column> columns;
  for (const std::string& column : candidate_columns() + more)
    if (column != "technique" && column != "parameters") columns.push_back({column, "/" + column});
  return columns;
}

Columns count_columns(const std::string& prefix) {
  Columns columns;
  for_each_term(Counts<double>{},
                [&](std::string_view term, double) { columns.push_back(prefix + std::string(term)); });
  columns.push_back(prefix + "tests");
  return columns;
}

Json workload_cells(const Json& inputs) {
  Json cells;
  for (const std::string& column : workload_columns())
    if (inputs.contains(column)) cells[column] = inputs[column];
  return cells;
}

Json candidate_cells(const Candidate& candidate) { return cells_of(candidate_fields(), candidate); }

Json count_cells(const Json& counts) {
  Json cells = counts;
  cells["tests"] = counts["cull_tests"].get<double>() + counts["disc_tests"].get<double>();
  return cells;
}

Json extrapolated_json(const std::vector<std::string>& reasons) {
  return {{"extrapolated", !reasons.empty()}, {"extrapolated_because", reasons}};
}

Json whole_json(const WholeSeconds& seconds) {
  return {{"read", seconds.read},
          {"trace", seconds.trace},
          {"prepare", seconds.prepare},
          {"search", seconds.search},
          {"total", seconds.total()}};
}

}  // namespace detp::validate
