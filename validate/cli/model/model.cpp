#include <fmt/format.h>

#include <cmath>
#include <map>
#include <stdexcept>

#include "detp/model/rank/extrapolation.hpp"
#include "detp/model/rank/registry.hpp"
#include "detp/validate/cli/command.hpp"
#include "detp/validate/cli/options/candidate_options.hpp"
#include "detp/validate/cli/options/cost_options.hpp"
#include "detp/validate/cli/options/workload_options.hpp"
#include "detp/validate/cli/report/answer_rows.hpp"
#include "detp/validate/cli/report/prediction_report.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/words.hpp"
#include "model_answer.hpp"

namespace detp::cli {
namespace {

struct ModelOptions {
  WorkloadOptions workload;
  CandidateOptions candidate;
  std::string form = "corrected";
  std::string costs;
  std::optional<std::int64_t> levels;
  bool verbose = false;
  OutlookOptions outlook;
};

using Answer = ModelAnswer(const ModelQuestion& question);

const std::map<Technique, Answer*>& answers() {
  static const std::map<Technique, Answer*> all{{Technique::sphere_cache, sphere_cache_answer},
                                                {Technique::sphere_cache_published, sphere_cache_answer},
                                                {Technique::cell_spheres, cell_spheres_answer},
                                                {Technique::sphere_tree, sphere_tree_answer},
                                                {Technique::octree, octree_answer},
                                                {Technique::grid, grid_answer}};
  return all;
}

ModelAnswer answer(const ModelQuestion& question) {
  if (!model::has_closed_form(question.technique))
    throw std::invalid_argument(fmt::format("there is no closed form of {}; try: detp run --technique {}",
                                            name(question.technique), name(question.technique)));
  const auto found = answers().find(question.technique);
  return found == answers().end() ? technique_answer(question) : found->second(question);
}

std::string level_table(const Json& levels) {
  if (levels.empty()) return {};
  std::string text = "\n";
  for (const auto& [key, value] : levels[0].items()) text += fmt::format("{}{:>13}", text == "\n" ? "" : " ", key);
  for (const Json& level : levels) {
    std::string line;
    for (const auto& [key, value] : level.items())
      line += fmt::format("{}{:>13.6g}", line.empty() ? "" : " ", value.get<double>());
    text += "\n" + line;
  }
  return text + "\n";
}

std::string scalars(const Json& json, const std::string& pattern_prefix = "") {
  std::string text;
  for (const auto& [key, value] : json.items()) {
    if (value.is_array() || value.is_boolean()) continue;
    if (value.is_object())
      text += scalars(value, key + ".");
    else if (value.is_number())
      text += fmt::format("{:<26} {:.8g}\n", pattern_prefix + key, value.get<double>());
    else
      text += fmt::format("{:<26} {}\n", pattern_prefix + key, value.get<std::string>());
  }
  return text;
}

std::string notes_text(const Json& json, const Screen& screen) {
  const Json notes = json.value("notes", Json::array());
  std::string text = notes.empty() ? "" : "\n";
  for (const Json& note : notes) text += legend(screen, note.get<std::string>());
  return text;
}

std::string why_extrapolated(const Json& json) {
  std::string text;
  for (const Json& reason : json.value("extrapolated_because", Json::array()))
    text += (text.empty() ? "caution   outside of what was compared with counts: " : "; ") + reason.get<std::string>();
  return text.empty() ? text : text + "\n";
}

/// Results of --curvature and --target-error, a line each.
std::string errors_text(const Json& json) {
  std::string text;
  for (const std::string& key : error_columns())
    if (json.contains(key)) text += fmt::format("{:<26} {:.8g}\n", key, json[key].get<double>());
  return text;
}

struct Sentences {
  std::string answer;
  std::string command;  ///< one line, whatever the width
};

/// Sentences, or with --verbose the whole record.
std::string text_of(const Json& json, const Sentences& sentences, const ModelOptions& options, const Screen& screen) {
  std::string text;
  for (const std::string& part : {sentences.answer, why_extrapolated(json)})
    if (!part.empty()) text += wrapped(std::string_view(part).substr(0, part.size() - 1), screen.text_width(), 10);
  text += sentences.command;
  if (options.verbose) return text + "\n" + scalars(json) + level_table(json.value("spheres", Json::array()));
  return text + (options.outlook.given() ? errors_text(json) : "");
}

const Columns& times() {
  static const Columns columns{"rebuild_time", "intersect_time", "copy_time",  "order_time",
                               "build_time",   "traverse_time",  "total_time", "rebuild_time_few_samples",
                               "balanced_time"};
  return columns;
}

const Columns& per_line() {
  static const Columns columns{"cells_per_line", "discs_per_cell", "tests_per_line", "cells_per_disc", "index_bytes"};
  return columns;
}

const Columns& of_one_sphere() {
  static const Columns columns{"i", "radius_i", "rays_i", "listed_i", "rebuilds_i", "rebuild_cost_i", "samples_i"};
  return columns;
}

/// Of a sphere cache.
const Columns& stop_columns() {
  static const Columns columns{"k", "k_max", "k_best", "k_published", "k_corrected", "extrapolated"};
  return columns;
}

Columns unit_cost_columns() {
  Columns columns;
  const Json costs = to_json(UnitCosts{});
  for (const auto& [name, cost] : costs.items()) columns.push_back("cost_" + name);
  return columns;
}

Columns columns() {
  return workload_columns() + candidate_columns() + Columns{"curvature", "target_error", "form"} + stop_columns() +
         times() + per_line() + outlook_columns() + count_columns() + unit_cost_columns() + of_one_sphere();
}

std::vector<Json> cells_of(const Json& inputs, const Candidate& candidate, const Json& json) {
  Json shared = workload_cells(inputs);
  shared.update(candidate_cells(candidate));
  for (const auto& [name, value] : json.items())
    if (!value.is_structured()) shared[name] = value;
  for (const char* input : {"curvature", "target_error"})
    if (inputs.contains(input)) shared[input] = inputs[input];
  if (json.contains("counts")) shared.update(count_cells(json["counts"]));
  for (const auto& [name, cost] : inputs["unit_costs"].items()) shared["cost_" + name] = cost;
  std::vector<Json> rows;
  for (const Json& sphere : json.value("spheres", Json::array())) {
    Json& row = rows.emplace_back(shared);
    for (const auto& [name, value] : sphere.items()) row[name == "i" ? name : name + "_i"] = value;
  }
  if (rows.empty()) rows.push_back(std::move(shared));
  return rows;
}

void require_finite_time(const Json& json) {
  if (!std::isfinite(json["total_time"].get<double>()))
    throw std::invalid_argument("with these unit costs the time exceeds 1.8e308; give smaller costs");
}

/// The data that the rows of one workload share.
struct Measured {
  Workload workload;
  Json inputs;
  std::string options;  ///< that give detp validate the same workload; empty if they are not known
};

Measured measure(const ModelOptions& options, const CommonOptions& common, const std::stop_token& stop) {
  validate::JobRequest request = options.workload.request(common);
  request.workload_only = true;
  if (request.numbers_alone()) {
    const Workload workload = validate::workload_of_numbers(request);
    std::string options = fmt::format("--samples {} --disc-radius {:.6g} --scene-side {:.6g}", workload.samples,
                                      workload.disc_radius, scene_side(workload));
    if (workload.dimension < 3) options += fmt::format(" --dimension {:.6g}", workload.dimension);
    return {workload, numbers_json(workload), options};
  }
  const validate::Job job = validate::make_job(request, stop);
  note_all(common, job);
  const bool scene_alone = request.scene && !request.disc_file && !request.ray_file;
  return {job.workload(), to_json(job, request),
          scene_alone ? fmt::format("{} --disc-radius {:.6g}", shell_word(*request.scene), job.given.disc_radius) : ""};
}

AnswerRow answer_row(const ModelOptions& options, const Measured& measured, const UnitCosts& costs, std::int64_t levels,
                     Sentences& sentences) {
  const Technique technique = options.candidate.technique_or(Technique::sphere_cache);
  (void)options.candidate.fixed_parameters(technique);  // throws for parameters of other techniques
  const Form form = choice_named<Form>(options.form).value();
  AnswerRow row{measured.inputs, {{"technique", name(technique)}}, {}};
  row.inputs["form"] = options.form;
  row.inputs["engine"] = name(options.candidate.engine);
  row.inputs["unit_costs"] = to_json(costs);
  row.inputs["levels"] = levels;
  if (options.outlook.curvature) row.inputs["curvature"] = *options.outlook.curvature;
  if (options.outlook.target_error) row.inputs["target_error"] = *options.outlook.target_error;
  const ModelQuestion question{measured.workload, technique, form, costs, levels, options.candidate};
  ModelAnswer found = answer(question);
  row.answer.update(found.json);
  row.answer.update(outlook(question, found.parameters, options.outlook));
  row.answer.update(extrapolated_json(model::extrapolations(measured.workload, {technique, found.parameters})));
  require_finite_time(row.answer);
  sentences = {model_sentences(question, found, !options.costs.empty()),
               measured.options.empty() ? "" : counting_command(question, found, measured.options)};
  row.cells = cells_of(row.inputs, {technique, found.parameters}, row.answer);
  return row;
}

Result run_model(ModelOptions& options, const CommonOptions& common, const std::stop_token& stop) {
  const std::size_t expected = rows_in(options.workload.lists, options.candidate.lists);
  const std::int64_t levels = options.levels.value_or(expected == 1 ? 64 : 0);
  require_count("--levels", static_cast<double>(levels), 0, 1e6);
  const UnitCosts costs = parse_unit_costs(options.costs).value_or(UnitCosts{});
  Sentences sentences;
  const auto rows = answer_all(
      options.workload.lists, options.candidate.lists, stop, [&] { return measure(options, common, stop); },
      [&](const Measured& measured) { return answer_row(options, measured, costs, levels, sentences); });
  Result result =
      result_of(rows, expected, columns(),
                {workload_columns() + candidate_columns() + Columns{"form", "curvature", "target_error"},
                 stop_columns() + (options.outlook.given() ? error_columns() : Columns{}) + times() + per_line(),
                 common.screen()});
  if (expected == 1) result.text = text_of(result.json, sentences, options, common.screen());
  result.text += notes_text(rows.front().answer, common.screen());
  return result;
}

}  // namespace

Command model_command(CLI::App& program) {
  CLI::App* app = program.add_subcommand("model", "The closed forms for one technique");
  app->footer(
      "Numbers may be lists and ranges, as 1%,2%,4% and 0.3:0.9:0.05: every combination makes a row.\n"
      "growth_power p and growth_logarithms q: with discs as large as samples are apart, the time of the best "
      "parameters grows as n_R n_P^p (log n_P)^q.\n"
      "Example: detp model --rays 1e5 --samples 1e5 --disc-radius 0.01 --scene-side 2 --ratio 0.65");
  const auto options = std::make_shared<ModelOptions>();
  options->workload.add_to(*app, Values::many);
  options->candidate.add_to(*app, Values::many, SphereStop::max);
  options->candidate.lists.add_word(*app, "--form", Values::many, options->form, {"published", "corrected"},
                                    "published or corrected; default: corrected");
  app->add_option("--costs", options->costs, unit_cost_help() + "\ndefault: t, u, w, v, n 1, so that times are counts");
  add_number(*app, "--levels", options->levels, "how many spheres to list; default: 64, of several rows none");
  options->outlook.add_to(*app, options->candidate.lists);
  app->add_flag("--verbose", options->verbose,
                "text with all that JSON has: every sphere, count and time; default: sentences");
  return {app, [options](const CommonOptions& common, const std::stop_token& stop) {
            return run_model(*options, common, stop);
          }};
}

}  // namespace detp::cli
