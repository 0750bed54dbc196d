#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <memory>

#include "command.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/validate/cli/options/candidate_options.hpp"
#include "detp/validate/cli/options/cost_options.hpp"
#include "detp/validate/cli/options/workload_options.hpp"
#include "detp/validate/cli/report/answer_rows.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/words.hpp"
#include "detp/validate/closed_forms/closed_forms.hpp"

namespace detp::cli {
namespace {

using validate::ModelAnswer;
using validate::ModelRequest;

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
    std::string words = fmt::format("--samples {} --disc-radius {:.6g} --scene-side {:.6g}", workload.samples,
                                    workload.disc_radius, scene_side(workload));
    if (workload.dimension < 3) words += fmt::format(" --dimension {:.6g}", workload.dimension);
    return {workload, numbers_json(workload), words};
  }
  const validate::Job job = validate::make_job(request, stop);
  note_all(common, job);
  const bool scene_alone = request.scene && !request.disc_file && !request.ray_file;
  return {job.workload(), to_json(job, request),
          scene_alone ? fmt::format("{} --disc-radius {:.6g}", shell_word(*request.scene), job.given.disc_radius) : ""};
}

ModelRequest model_request(const ModelOptions& options, const Workload& workload, std::int64_t levels) {
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

/// A time in the unit of the costs.
std::string amount(double time, bool with_costs) {
  return with_costs ? fmt::format("{:.4g} s", time) : fmt::format("{:.4g}", time);
}

std::string compared(double time, double with) {
  const double change = 100 * (time / with - 1);
  return std::abs(change) < 0.05 ? "the same T"
                                 : fmt::format("{:.3g} % {} T", std::abs(change), change < 0 ? "less" : "more");
}

std::string time_line(const validate::ModelTimes& times, bool with_costs) {
  std::string text = "T         " + amount(times.total, with_costs);
  std::string list;
  for (const auto& [part, meaning] : {std::pair{times.rebuild, "T_R (making lists of rays)"},
                                      {times.traverse, "walking through cells"},
                                      {times.intersect, "T_I (testing rays with discs)"},
                                      {times.copy, "copying rays"},
                                      {times.order, "sorting discs"},
                                      {times.build, "building the index"}})
    if (part.value_or(0) > 0)
      list += fmt::format("{}{} {}", list.empty() ? "" : ", ", meaning, amount(*part, with_costs));
  if (!list.empty()) text += " = " + list;
  return text + (with_costs ? "" : ". Every test and step costs 1 (--costs gives seconds)") + "\n";
}

/// The parameters of least T by the question's form.
std::string best_line(const ModelAnswer& answer, const validate::ModelComparison& than, bool with_costs) {
  if (!than.best) return "";
  const std::string t =
      fmt::format("T = {}, {}\n", amount(than.best_time, with_costs), compared(than.best_time, answer.times.total));
  if (!answer.stops)
    return than.best->parameters == answer.candidate.parameters ? "best      these parameters, by this formula\n"
                                                                : fmt::format("best      {}: {}", title(*than.best), t);
  const auto* cache = std::get_if<SphereCacheParameters>(&than.best->parameters);
  return cache == nullptr ? "best      no sphere: every ray is tested with every disc\n"
                          : fmt::format("best      Q = {:.3g} with k = {}: {}", cache->ratio, cache->spheres, t);
}

std::string stop_line(const validate::CacheStops& stops) {
  const auto& [k, most, best, published, corrected] = stops;
  if (most == 0) return "k         0: no sphere holds a disc, so every ray is tested with every disc\n";
  return fmt::format(
      "k         {}; {}. detp run takes the fastest, or --spheres\n",
      k == most ? fmt::format("{}, all spheres that can hold a disc", k)
                : fmt::format("{} of the {} spheres that can hold a disc", k, most),
      k == best ? "this k is the fastest at this Q" : fmt::format("at this Q k = {} is the fastest", best));
}

std::string other_form_line(const ModelAnswer& answer, const ModelAnswer& other, bool with_costs) {
  std::string text = fmt::format("{:<9} T = {}", name(other.form), amount(other.times.total, with_costs));
  if (other.stops) text += fmt::format(" with k = {}", other.stops->spheres);
  return text + fmt::format(", {:.2g} of the {} form\n", other.times.total / answer.times.total, name(answer.form));
}

std::string sentences(const ModelRequest& request, const ModelAnswer& answer, bool with_costs) {
  const Workload& w = request.workload;
  std::string text = fmt::format("technique {}, {} form\n", title(answer.candidate), name(answer.form));
  text += fmt::format("workload  {:.6g} {}, {:.6g} samples, d = {:.4g}, r0 = {:.4g}, D = {:.2f}\n", w.rays,
                      w.path_length > 0 ? "rays that end" : "lines", w.samples, w.disc_radius, w.sphere_radius,
                      w.dimension);
  text += time_line(answer.times, with_costs);
  const validate::ModelComparison than = compare(request, answer);
  text += best_line(answer, than, with_costs);
  if (answer.stops) text += stop_line(*answer.stops);
  if (than.other_form) text += other_form_line(answer, *than.other_form, with_costs);
  const double hits = model::expected_hits(w);
  text += fmt::format("hits      {:.4g} expected, {:.3g} a disc", hits, hits / w.samples);
  if (answer.extrapolated_because.empty()) return text;
  return text + fmt::format("\ncaution   outside of what was compared with counts: {}",
                            fmt::join(answer.extrapolated_because, "; "));
}

/// The command, to be pasted, that counts what the formulas predict; empty if there is none.
std::string counting_command(const ModelAnswer& answer, const std::string& workload) {
  using enum Technique;
  const Technique technique = answer.candidate.technique;
  if (workload.empty() || technique == brute_force || (answer.stops && answer.stops->most == 0)) return "";
  const std::string experiments =
      answer.stops
          ? fmt::format("sphere-cache --ratio {}", std::get<SphereCacheParameters>(answer.candidate.parameters).ratio)
      : technique == octree || technique == grid ? "index"
                                                 : "hierarchies";
  return fmt::format("command   detp validate {} --experiments {}\n", workload, experiments);
}

std::string scalars(const Json& json, const std::string& prefix = "") {
  std::string text;
  for (const auto& [key, value] : json.items()) {
    if (value.is_array() || value.is_boolean()) continue;
    if (value.is_object())
      text += scalars(value, key + ".");
    else if (value.is_number())
      text += fmt::format("{:<26} {:.8g}\n", prefix + key, value.get<double>());
    else
      text += fmt::format("{:<26} {}\n", prefix + key, value.get<std::string>());
  }
  return text;
}

std::string level_table(const Json& levels) {
  if (levels.empty()) return {};
  std::string text;
  for (const auto& [key, value] : levels[0].items()) text += fmt::format("{}{:>13}", text.empty() ? "\n" : " ", key);
  for (const Json& level : levels) {
    std::string line;
    for (const auto& [key, value] : level.items())
      line += fmt::format("{}{:>13.6g}", line.empty() ? "\n" : " ", value.get<double>());
    text += line;
  }
  return text + "\n";
}

/// In sentences: T and its parts, the best parameters, k, what the other form says, and the command that counts what the formulas predict.
std::string model_text(const ModelRequest& request, const ModelAnswer& answer, const ModelOptions& options,
                       const std::string& workload, const Screen& screen) {
  std::string text = wrapped(sentences(request, answer, !options.costs.empty()), screen.text_width(), 10) +
                     counting_command(answer, workload);
  if (!options.verbose) {
    if (!request.curvature && !request.target_error) return text;
    const Json errors = cells_of(validate::error_fields(), answer.outlook);
    for (const auto& [name, value] : errors.items()) text += fmt::format("{:<26} {:.8g}\n", name, value.get<double>());
    return text;
  }
  const Json json = json_of(answer);
  return text + "\n" + scalars(json) + level_table(json.value("spheres", Json::array()));
}

AnswerRow model_row(const ModelRequest& request, const ModelAnswer& answer, const Json& inputs) {
  AnswerRow row{inputs, {}, {}};
  row.inputs.update(inputs_of(request));
  row.answer = json_of(answer);
  for (const Json& cells : cells_of(request, answer)) {
    row.cells.push_back(workload_cells(inputs));
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
    const ModelRequest request = model_request(options, measured.workload, levels);
    const ModelAnswer answer = validate::answer(request);
    if (text.empty()) {
      notes = answer.outlook.notes;
      text = model_text(request, answer, options, measured.options, common.screen());
    }
    return model_row(request, answer, measured.inputs);
  };
  const auto rows = answer_all(
      options.workload.lists, options.candidate.lists, stop, [&] { return measure(options, common, stop); },
      answer_row);
  const Columns first = workload_columns() + candidate_columns();
  Result result = result_of(rows, expected, first + validate::model_columns(),
                            {first + Columns{"form", "curvature", "target_error"},
                             validate::main_model_columns(options.curvature || options.target_error), common.screen()});
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
  return {
      app,
      [options](const CommonOptions& common, const std::stop_token& stop) { return run_model(*options, common, stop); },
      false, validate::describe_model()};
}

}  // namespace detp::cli
