#include <fmt/format.h>

#include <memory>

#include "detp/validate/cli/command.hpp"
#include "detp/validate/cli/options/candidate_options.hpp"
#include "detp/validate/cli/options/cost_options.hpp"
#include "detp/validate/cli/options/workload_options.hpp"
#include "detp/validate/cli/report/answer_rows.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/words.hpp"
#include "model_text.hpp"

namespace detp::cli {
namespace {

struct ModelOptions {
  WorkloadOptions workload;
  CandidateOptions candidate;
  std::string form = "corrected";
  std::string costs;
  std::optional<std::int64_t> levels;
  std::optional<double> curvature;
  std::optional<double> target_error;
  bool verbose = false;
};

const Columns& unit_cost_columns() {
  static const Columns columns = [] {
    Columns all;
    const Json costs = to_json(UnitCosts{});
    for (const auto& [name, cost] : costs.items()) all.push_back("cost_" + name);
    return all;
  }();
  return columns;
}

Columns table_columns() {
  const auto [stops, times, index, errors, outlook, spheres] = validate::model_columns();
  return workload_columns() + candidate_columns() + Columns{"curvature", "target_error", "form"} + stops + times +
         index + outlook + count_columns() + unit_cost_columns() + spheres;
}

/// What is shown of several rows.
TextColumns text_columns(const ModelOptions& options, const Screen& screen) {
  const auto [stops, times, index, errors, outlook, spheres] = validate::model_columns();
  const bool with_errors = options.curvature || options.target_error;
  return {workload_columns() + candidate_columns() + Columns{"form", "curvature", "target_error"},
          stops + (with_errors ? errors : Columns{}) + times + index, screen};
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

validate::ModelRequest model_request(const ModelOptions& options, const Workload& workload, std::int64_t levels) {
  const Technique technique = options.candidate.technique_or(Technique::sphere_cache);
  return {.workload = workload,
          .technique = technique,
          .parameters = options.candidate.fixed_parameters(technique),
          .fastest_stop = options.candidate.stop == SphereStop::best,
          .form = choice_named<Form>(options.form).value(),
          .costs = parse_unit_costs(options.costs).value_or(UnitCosts{}),
          .engine = options.candidate.engine,
          .levels = levels,
          .curvature = options.curvature,
          .target_error = options.target_error};
}

AnswerRow model_row(const validate::ModelRequest& request, const validate::ModelAnswer& answer, const Json& inputs) {
  AnswerRow row{inputs, {{"technique", name(request.technique)}}, {}};
  row.inputs["form"] = name(request.form);
  row.inputs["engine"] = name(request.engine);
  row.inputs["unit_costs"] = to_json(request.costs);
  row.inputs["levels"] = request.levels;
  if (request.curvature) row.inputs["curvature"] = *request.curvature;
  if (request.target_error) row.inputs["target_error"] = *request.target_error;
  row.answer.update(json_of(answer));
  Json shared = workload_cells(row.inputs);
  for (const char* input : {"curvature", "target_error"})
    if (row.inputs.contains(input)) shared[input] = row.inputs[input];
  for (const auto& [name, cost] : row.inputs["unit_costs"].items()) shared["cost_" + name] = cost;
  for (const Json& cells : cells_of(answer)) {
    row.cells.push_back(shared);
    row.cells.back().update(cells);
  }
  return row;
}

Result run_model(ModelOptions& options, const CommonOptions& common, const std::stop_token& stop) {
  const std::size_t expected = rows_in(options.workload.lists, options.candidate.lists);
  const std::int64_t levels = options.levels.value_or(expected == 1 ? 64 : 0);
  require_count("--levels", static_cast<double>(levels), 0, 1e6);
  static_cast<void>(parse_unit_costs(options.costs));  // bad costs are refused before a scene is read
  std::string text;
  std::vector<std::string> notes;  // of the first row
  const auto answer_row = [&](const Measured& measured) {
    const validate::ModelRequest request = model_request(options, measured.workload, levels);
    const validate::ModelAnswer answer = validate::answer(request);
    if (text.empty()) {
      notes = answer.outlook.notes;
      text = text_of(request, answer, {!options.costs.empty(), options.verbose, measured.options}, common.screen());
    }
    return model_row(request, answer, measured.inputs);
  };
  const auto rows = answer_all(
      options.workload.lists, options.candidate.lists, stop, [&] { return measure(options, common, stop); },
      answer_row);
  Result result = result_of(rows, expected, table_columns(), text_columns(options, common.screen()));
  if (expected == 1) result.text = text;
  if (!notes.empty()) result.text += "\n";
  for (const std::string& one : notes) result.text += legend(common.screen(), one);
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
  add_number(*app, "--curvature", options->curvature,
             "Laplacian of the density of hits over the density, 1/length²: adds the error of discs (bias, total, best "
             "radius) and of the nearest photons");
  options->candidate.lists.add(
      *app, "--target-error", Values::many, ValueLists::Kind::numbers,
      [options = options.get()](const std::string& text) {
        options->target_error = parse_share("--target-error", text);
      },
      "of the irradiance, relative, as 5% or 0.05: adds the rays that reach it");
  app->add_flag("--verbose", options->verbose,
                "text with all that JSON has: every sphere, count and time; default: sentences");
  return {app, [options](const CommonOptions& common, const std::stop_token& stop) {
            return run_model(*options, common, stop);
          }};
}

}  // namespace detp::cli
