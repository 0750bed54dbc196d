#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "command.hpp"
#include "detp/model/best_ratio.hpp"
#include "detp/model/cell_spheres.hpp"
#include "detp/model/choose.hpp"
#include "detp/model/disc_index.hpp"
#include "detp/model/disc_index_published.hpp"
#include "detp/model/predict.hpp"
#include "detp/model/sphere_cache.hpp"
#include "detp/model/sphere_cache_published.hpp"
#include "detp/model/sphere_count.hpp"
#include "detp/model/sphere_tree.hpp"
#include "unit_cost_option.hpp"
#include "workload_options.hpp"

namespace detp::cli {
namespace {

using model::Form;

struct ModelOptions {
  WorkloadOptions workload;
  CandidateOptions candidate;
  std::string form = "corrected";
  std::string costs;
  std::int64_t levels = 64;
};

/// A resolved question to the closed forms.
struct Question {
  Workload workload;
  Technique technique;
  Form form;
  UnitCosts costs;
  std::int64_t levels;
  const CandidateOptions& options;
};

SphereCacheParameters cache_parameters(const Question& question) {
  SphereCacheParameters parameters{question.options.ratio.value_or(model::published_ratio), 0,
                                   question.options.sample_order()};
  parameters.spheres = model::sphere_count(question.form, {parameters.ratio}, {question.workload.disc_radius},
                                           {question.workload.sphere_radius});
  if (question.options.spheres) {
    require_count("number of spheres", static_cast<double>(*question.options.spheres), 0, 1e18);
    parameters.spheres = *question.options.spheres;
  }
  return parameters;
}

Json published_levels(const Question& question, const SphereCacheParameters& parameters) {
  Json levels = Json::array();
  const bool sorted = parameters.order == SampleOrder::lebesgue;
  for (std::int64_t i = 1; i <= std::min(question.levels, parameters.spheres); ++i)
    levels.push_back(
        {{"i", i},
         {"radius", question.workload.sphere_radius * std::pow(parameters.ratio, static_cast<double>(i))},
         {"rays", model::published::rays_in_sphere(question.workload.rays, {parameters.ratio}, i)},
         {"rebuilds", sorted ? model::published::rebuilds({parameters.ratio}, i) : question.workload.samples},
         {"rebuild_cost",
          model::published::rebuild_cost(question.workload.rays, {parameters.ratio}, i, question.costs.sphere_test)}});
  return levels;
}

Json published_cache(const Question& question, const SphereCacheParameters& parameters) {
  Json json{{"spheres", published_levels(question, parameters)}};
  if (parameters.order == SampleOrder::none) {
    json["total_time"] = model::published::unsorted_time(question.workload, question.costs.disc_test);
    return json;
  }
  const double rebuild = model::published::rebuild_time(question.workload, {parameters.ratio}, parameters.spheres,
                                                        question.costs.sphere_test);
  const double intersect = model::published::intersect_time(question.workload, {parameters.ratio}, parameters.spheres,
                                                            question.costs.disc_test);
  json["rebuild_time"] = rebuild;
  json["intersect_time"] = intersect;
  json["total_time"] = rebuild + intersect;
  json["rebuild_time_few_samples"] =
      model::published::rebuild_time_few_samples(question.workload, {parameters.ratio}, question.costs.sphere_test);
  return json;
}

Json corrected_levels(const Question& question, const SphereCacheParameters& parameters) {
  Json levels = Json::array();
  if (parameters.spheres == 0) return levels;
  for (const model::SphereLevel& level : model::sphere_levels(question.workload, parameters, question.levels))
    levels.push_back({{"i", level.i},
                      {"radius", level.radius},
                      {"rays", level.rays},
                      {"listed", level.listed},
                      {"rebuilds", level.rebuilds},
                      {"rebuild_cost", question.costs.sphere_test * level.tests}});
  return levels;
}

Json corrected_cache(const Question& question, const SphereCacheParameters& parameters) {
  const Candidate candidate = parameters.spheres == 0 ? Candidate{Technique::brute_force, BruteForceParameters{}}
                                                      : Candidate{Technique::sphere_cache, parameters};
  const Counts<double> counts = model::predict(question.workload, candidate);
  const CostBreakdown time = price(counts, question.costs);
  return {{"spheres", corrected_levels(question, parameters)},
          {"rebuild_time", time.rebuild},
          {"intersect_time", time.intersect},
          {"copy_time", time.copy},
          {"order_time", time.order},
          {"total_time", time.total()},
          {"counts", to_json(counts)}};
}

Json sphere_cache(const Question& question) {
  const SphereCacheParameters parameters = cache_parameters(question);
  Json json{{"parameters", to_json(Parameters{parameters})}, {"form", name(question.form)}, {"k", parameters.spheres}};
  json.update(question.form == Form::published ? published_cache(question, parameters)
                                               : corrected_cache(question, parameters));
  return json;
}

Json published_octree(const Question& question, int depth) {
  const Workload& w = question.workload;
  return {{"depth", depth},
          {"cells_per_line", model::published::cells_per_line(depth)},
          {"discs_per_cell", model::published::discs_per_cell(w.samples, depth)},
          {"tests_per_line", model::published::tests_per_line(w.samples, depth)},
          {"total_time", model::published::octree_time(w, depth, question.costs.disc_test)},
          {"balanced_time", model::published::balanced_octree_time(w, depth, question.costs.disc_test)}};
}

/// Per line that hits the index's box.
Json corrected_index(const Question& question, double parts, const Counts<double>& counts) {
  const model::Cells cells = model::index_cells(question.workload, parts);
  const double references = question.workload.samples * cells.overlapped;
  double area = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) area += 2 * cells.along[axis] * cells.along[(axis + 1) % 3];
  const double share = 6 / area;  // P(cell) over P(box): areas in units of a cell's face
  const CostBreakdown time = price(counts, question.costs);
  return {{"cells_per_line", cells.count() * share},
          {"discs_per_cell", references / cells.count()},
          {"tests_per_line", references * share},
          {"cells_per_disc", cells.overlapped},
          {"build_time", time.build},
          {"traverse_time", time.traverse},
          {"intersect_time", time.intersect},
          {"total_time", time.total()},
          {"counts", to_json(counts)}};
}

Json octree(const Question& question) {
  const int depth = question.options.depth.value_or(
      model::published::octree_depth({question.workload.disc_radius}, scene_side(question.workload)));
  const OctreeParameters parameters{depth};
  const Counts<double> counts = model::octree_counts(question.workload, parameters);
  Json json{{"parameters", to_json(Parameters{parameters})}, {"form", name(question.form)}, {"depth", depth}};
  json.update(question.form == Form::published ? published_octree(question, depth)
                                               : corrected_index(question, std::ldexp(1.0, depth), counts));
  return json;
}

/// Where the paper has none.
void refuse_published(const Question& question) {
  if (question.form == Form::published)
    throw std::invalid_argument(
        fmt::format("the paper has no formula for {}; use --form corrected", detp::name(question.technique)));
}

Json grid(const Question& question) {
  refuse_published(question);
  const int depth = model::published::octree_depth({question.workload.disc_radius}, scene_side(question.workload));
  const GridParameters parameters{question.options.cells.value_or(1 << std::min(depth, 20))};
  const Counts<double> counts = model::grid_counts(question.workload, parameters);
  Json json{{"parameters", to_json(Parameters{parameters})}, {"form", name(question.form)}};
  json.update(corrected_index(question, parameters.cells, counts));
  return json;
}

/// Parameters, time by part and counts, after the levels.
Json with_spheres(const Question& question, const Parameters& parameters, Json levels) {
  const Counts<double> counts = model::predict(question.workload, {question.technique, parameters});
  const CostBreakdown time = price(counts, question.costs);
  return {{"parameters", to_json(parameters)}, {"form", name(question.form)},      {"spheres", std::move(levels)},
          {"rebuild_time", time.rebuild},      {"intersect_time", time.intersect}, {"copy_time", time.copy},
          {"order_time", time.order},          {"total_time", time.total()},       {"counts", to_json(counts)}};
}

/// Levels left out are the best at the unit costs.
Json cell_spheres(const Question& question) {
  refuse_published(question);
  const Workload& w = question.workload;
  const auto best = [&] {
    return std::get<CellSpheresParameters>(
        model::best_of(Technique::cell_spheres, w, question.costs)->candidate.parameters);
  };
  const CellSpheresParameters parameters =
      question.options.depth ? CellSpheresParameters{*question.options.depth} : best();
  check(Candidate{Technique::cell_spheres, parameters});
  Json levels = Json::array();
  double around = w.rays;
  for (int i = 1; i <= std::min<std::int64_t>(question.levels, parameters.depth); ++i) {
    const double rays = model::rays_in_cell_sphere(w, i);
    levels.push_back({{"i", i},
                      {"radius", model::cell_sphere_radius(w, i)},
                      {"rays", rays},
                      {"rebuilds", model::occupied_cell_spheres(w, i)},
                      {"rebuild_cost", question.costs.sphere_test * around}});
    around = rays;
  }
  return with_spheres(question, parameters, std::move(levels));
}

Json sphere_tree(const Question& question) {
  refuse_published(question);
  const SphereTreeParameters parameters =
      model::best_sphere_tree(question.workload, question.costs, question.options.fan_out, question.options.leaf);
  Json levels = Json::array();
  double around = question.workload.rays;
  for (const model::TreeLevel& level : model::sphere_tree_levels(question.workload, parameters)) {
    if (static_cast<std::int64_t>(levels.size()) == question.levels) break;
    levels.push_back({{"i", levels.size()},
                      {"radius", level.rms_radius},
                      {"rays", level.rays},
                      {"rebuilds", level.nodes},
                      {"rebuild_cost", question.costs.sphere_test * around},
                      {"samples", level.samples}});
    around = level.rays;
  }
  return with_spheres(question, parameters, std::move(levels));
}

Json brute_force(const Question& question) {
  const Counts<double> counts = model::predict(question.workload, {Technique::brute_force, BruteForceParameters{}});
  return {{"parameters", Json::object()},
          {"form", name(question.form)},
          {"total_time", price(counts, question.costs).total()},
          {"counts", to_json(counts)}};
}

Json answer(const Question& question) {
  Json json{{"technique", name(question.technique)}};
  switch (question.technique) {
    case Technique::brute_force:
      json.update(brute_force(question));
      break;
    case Technique::sphere_cache:
    case Technique::sphere_cache_published:
      json.update(sphere_cache(question));
      break;
    case Technique::cell_spheres:
      json.update(cell_spheres(question));
      break;
    case Technique::sphere_tree:
      json.update(sphere_tree(question));
      break;
    case Technique::octree:
      json.update(octree(question));
      break;
    case Technique::grid:
      json.update(grid(question));
      break;
  }
  return json;
}

std::string level_table(const Json& levels, std::string_view separator) {
  if (levels.empty()) return {};
  std::string text;
  for (const auto& [key, value] : levels[0].items()) {
    const std::string cell = separator == "," ? key : fmt::format("{:>13}", key);
    text += text.empty() ? cell : std::string(separator) + cell;
  }
  text += "\n";
  for (const Json& level : levels) {
    std::string line;
    for (const auto& [key, value] : level.items()) {
      const std::string cell = separator == "," ? value.dump() : fmt::format("{:>13.6g}", value.get<double>());
      line += line.empty() ? cell : std::string(separator) + cell;
    }
    text += line + "\n";
  }
  return text;
}

std::string scalars(const Json& json, const std::string& pattern_prefix = "") {
  std::string text;
  for (const auto& [key, value] : json.items()) {
    if (key == "spheres" || value.is_array()) continue;
    if (value.is_object())
      text += scalars(value, key + ".");
    else if (value.is_number())
      text += fmt::format("{:<26} {:.8g}\n", pattern_prefix + key, value.get<double>());
    else
      text += fmt::format("{:<26} {}\n", pattern_prefix + key, value.get<std::string>());
  }
  return text;
}

std::string csv_scalars(const Json& json) {
  std::string header;
  std::string row;
  for (const auto& [key, value] : json.items())
    if (value.is_number() || value.is_string()) {
      header += (header.empty() ? "" : ",") + key;
      row += (row.empty() ? "" : ",") + (value.is_string() ? value.get<std::string>() : value.dump());
    }
  return header + "\n" + row + "\n";
}

Result run_model(const ModelOptions& options, const CommonOptions& common) {
  Result result;
  const validate::JobRequest request = options.workload.request(common);
  Workload workload;
  if (request.numbers_alone()) {
    workload = validate::workload_of_numbers(request);
    result.inputs = to_json(workload);
  } else {
    const validate::Job job = validate::make_job(request);
    for (const std::string& notice : job.notices) note(common, notice);
    workload = job.workload;
    result.inputs = to_json(job, request);
  }
  const Technique technique = options.candidate.technique_or(Technique::sphere_cache);
  options.candidate.refuse_foreign(technique);
  require_count("--levels", static_cast<double>(options.levels), 0, 1e6);
  const Form form = options.form == "published" ? Form::published : Form::corrected;
  const Question question{workload,       technique,        form, parse_unit_costs(options.costs, UnitCosts{}),
                          options.levels, options.candidate};
  result.inputs["form"] = options.form;
  result.inputs["unit_costs"] = to_json(question.costs);
  result.inputs["levels"] = options.levels;
  result.json = answer(question);
  result.text = scalars(result.json);
  result.csv = csv_scalars(result.json);
  if (result.json.contains("spheres")) {
    result.text += "\n" + level_table(result.json["spheres"], " ");
    if (!result.json["spheres"].empty()) result.csv = level_table(result.json["spheres"], ",");
  }
  return result;
}

}  // namespace

Command model_command(CLI::App& program) {
  CLI::App* app = program.add_subcommand("model", "The closed forms for one technique");
  app->footer("Example: detp model --rays 1e5 --samples 1e5 --disc-radius 0.01 --scene-side 2 --ratio 0.65");
  const auto options = std::make_shared<ModelOptions>();
  options->workload.add_to(*app);
  options->candidate.add_to(*app);
  app->add_option("--form", options->form, "published or corrected")->check(CLI::IsMember({"published", "corrected"}));
  app->add_option("--costs", options->costs, "unit costs, as t=4e-9,u=2e-9; default 1: times are operation counts");
  app->add_option("--levels", options->levels, "how many spheres to list");
  return {app, [options](const CommonOptions& common, std::stop_token) { return run_model(*options, common); }};
}

}  // namespace detp::cli
