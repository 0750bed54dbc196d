#include <fmt/format.h>

#include <stdexcept>

#include "command.hpp"
#include "detp/model/predict.hpp"
#include "model_answer.hpp"
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

Json brute_force(const ModelQuestion& question) {
  const Counts<double> counts = model::predict(question.workload, {Technique::brute_force, BruteForceParameters{}});
  return {{"parameters", Json::object()},
          {"form", name(question.form)},
          {"total_time", price(counts, question.costs).total()},
          {"counts", to_json(counts)}};
}

Json answer(const ModelQuestion& question) {
  Json json{{"technique", name(question.technique)}};
  switch (question.technique) {
    case Technique::brute_force:
      json.update(brute_force(question));
      break;
    case Technique::sphere_cache:
    case Technique::sphere_cache_published:
      json.update(sphere_cache_answer(question));
      break;
    case Technique::cell_spheres:
      json.update(cell_spheres_answer(question));
      break;
    case Technique::sphere_tree:
      json.update(sphere_tree_answer(question));
      break;
    case Technique::octree:
      json.update(octree_answer(question));
      break;
    case Technique::grid:
      json.update(grid_answer(question));
      break;
    case Technique::bsp:
    case Technique::bvh:
    case Technique::photon_map:
      throw std::invalid_argument(fmt::format("there is no closed form of {}; try: detp run --technique {}",
                                              name(question.technique), name(question.technique)));
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
  const ModelQuestion question{workload,       technique,        form, parse_unit_costs(options.costs, UnitCosts{}),
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
