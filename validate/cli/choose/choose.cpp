#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "choose_text.hpp"
#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/validate/cli/command.hpp"
#include "detp/validate/cli/options/candidate_options.hpp"
#include "detp/validate/cli/options/cost_options.hpp"
#include "detp/validate/cli/options/workload_options.hpp"
#include "detp/validate/cli/report/answer_rows.hpp"
#include "detp/validate/cli/report/effects_report.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/map/map_summary.hpp"

namespace detp::cli {
namespace {

bool is_in(const std::vector<Technique>& list, Technique technique) {
  return std::find(list.begin(), list.end(), technique) != list.end();
}

struct ChooseOptions {
  WorkloadOptions workload;
  CostOptions costs;
  std::optional<std::string> rigor;
  std::string engine = "simd";
  std::vector<std::string> technique;
  std::vector<std::string> disable;
  bool analyze = false;
  bool map = false;
  bool verbose = false;
  std::optional<std::string> checkpoint;
  bool resume = false;
  std::optional<double> ranks;
  double network = validate::RanksRequest{}.bytes_per_second;
};

/// The exact techniques that may not be chosen: those of --disable, and those that --technique does not name. Throws
/// std::invalid_argument for an unknown name, for one in --technique that is not exact, and if none is left.
std::vector<Technique> disabled_techniques(const ChooseOptions& options) {
  std::vector<Technique> only;
  for (const std::string& text : options.technique) {
    only.push_back(parse_technique(text));
    if (!record_of(only.back()).exact)
      throw std::invalid_argument(
          fmt::format("--technique: {} is never chosen, because it does not find all hits", text));
  }
  std::vector<Technique> disabled;
  for (const std::string& text : options.disable) disabled.push_back(parse_technique(text));
  for (const Technique technique : exact_techniques)
    if (!only.empty() && !is_in(only, technique) && !is_in(disabled, technique)) disabled.push_back(technique);
  const bool all = std::ranges::all_of(exact_techniques, [&](Technique technique) {
    return !model::has_closed_form(technique) || is_in(disabled, technique);
  });
  if (all)
    throw std::invalid_argument(fmt::format("{} leaves no technique that can be predicted",
                                            only.empty()              ? "--disable"
                                            : options.disable.empty() ? "--technique"
                                                                      : "--technique with --disable"));
  return disabled;
}

/// The rigor that the option names; nothing if it is not set. Throws std::invalid_argument for an unknown name.
std::optional<Rigor> requested_rigor(const ChooseOptions& options) {
  if (!options.rigor) return std::nullopt;
  const auto rigor = choice_named<Rigor>(*options.rigor);
  if (!rigor)
    throw std::invalid_argument(
        fmt::format("rigor must be estimate, structural, pilot or measure (got '{}')", shortened(*options.rigor)));
  return rigor;
}

void check_options(const ChooseOptions& options, std::optional<Rigor> rigor, const std::vector<Technique>& disabled) {
  if (options.map && options.ranks) throw std::invalid_argument("--ranks is for one workload, not for --map");
  if (options.ranks) require_count("--ranks", *options.ranks, 1, 1e6);
  require_positive("--network", options.network);
  if (options.checkpoint && !(options.map && options.analyze))
    throw std::invalid_argument("--checkpoint keeps the measured cells of --map with --analyze");
  if (options.map && rigor == Rigor::measure)
    throw std::invalid_argument("--rigor measure chooses for one workload; with --map give --analyze");
  if (rigor != Rigor::pilot && rigor != Rigor::structural) return;
  if (parse_engine(options.engine) == Engine::plain)
    throw std::invalid_argument(fmt::format(
        "--rigor {} counts for the simd engine; with --engine plain give --rigor estimate", *options.rigor));
  if (is_in(disabled, Technique::box_tree))
    throw std::invalid_argument(fmt::format(
        "--rigor {} counts the tests of box trees, but box-tree may not be chosen; give --rigor estimate or "
        "measure",
        *options.rigor));
}

/// A row for each candidate, then for that of the paper's rule.
std::string to_csv(const validate::ChooseAnswer& answer, const Json& inputs, const Json& json) {
  const auto& of_rows = validate::choose_row_fields();
  Table table(workload_columns() + effect_columns() + Columns{"warnings"} + columns_of(of_rows) +
              columns_of(validate::choose_fields()));
  Json shared = workload_cells(inputs);
  shared.update(effect_cells(json["effects"]));
  shared["warnings"] = validate::one_cell(json["warnings"]);
  shared.update(cells_of(validate::choose_fields(), answer));
  const auto add = [&](const validate::ChooseRow& row) {
    Json cells = shared;
    cells.update(cells_of(of_rows, row));
    table.add(cells);
  };
  for (const validate::ChooseRow& row : rows_of(answer)) add(row);
  add(paper_row(answer));
  return table.csv();
}

Json inputs_of(const validate::ChooseRequest& request, const validate::ChooseAnswer& answer) {
  Json json = answer.job ? to_json(*answer.job, request.job) : numbers_json(answer.workload);
  json["unit_costs"] = to_json(request.costs);
  json["rigor"] = name(answer.rigor);
  json["analyze"] = request.analyzes();
  json["engine"] = name(request.costs.engine);
  json["disabled"] = names_json(request.disabled);
  json["threads"] = request.threads;
  json["ranks"] = request.ranks ? Json(request.ranks->ranks) : Json();
  return json;
}

/// The axes are the values of --rays and --disc-radius.
validate::MapRequest map_request(ChooseOptions& options, const CommonOptions& common) {
  validate::MapRequest request;
  for (std::size_t row = 0; row < options.workload.lists.rows(); ++row) {
    options.workload.lists.choose_row(row);
    request.job = options.workload.request(common, false);
    if (request.job.rays) request.axes.rays.push_back(*request.job.rays);
    if (request.job.disc_radius) request.axes.radii.push_back(*request.job.disc_radius);
  }
  if (request.job.numbers_alone()) {
    if (!request.job.disc_radius) request.job.disc_radius = validate::default_map_radii().front();
    require_numbers(request.job);
  }
  request.measure = options.analyze;
  request.threads = common.threads;
  request.checkpoint = options.checkpoint;
  request.resume = options.resume;
  return request;
}

Result run_choose(ChooseOptions& options, const CommonOptions& common, const std::stop_token& stop) {
  const auto rigor = requested_rigor(options);
  const std::vector<Technique> disabled = disabled_techniques(options);
  check_options(options, rigor, disabled);
  const Engine engine = parse_engine(options.engine);
  if (options.map) {
    validate::MapRequest request = map_request(options, common);
    const CostsInUse costs = options.costs.costs(common);
    note_doubt(costs, common);
    request.costs = costs.of(engine);
    request.costs_origin = costs.origin;
    request.rigor = rigor;
    request.disabled = disabled;
    return run_choose_map(request, common, options.verbose, stop);
  }
  if (options.workload.lists.rows() > 1)
    throw std::invalid_argument("only with --map may --rays and --disc-radius have several values");
  options.workload.lists.choose_row(0);
  const CostsInUse costs = options.costs.costs(common);
  note_doubt(costs, common);
  validate::ChooseRequest request{.job = options.workload.request(common),
                                  .costs = costs.of(engine),
                                  .costs_origin = costs.origin,
                                  .rigor = rigor,
                                  .analyze = options.analyze,
                                  .disabled = disabled,
                                  .threads = sim::useful_threads(common.threads),
                                  .made = [&](const validate::Job& job) { note_all(common, job); }};
  if (options.ranks) request.ranks = {*options.ranks, options.network};
  if (request.job.numbers_alone() && rigor == Rigor::pilot)
    throw std::invalid_argument("--rigor pilot needs rays: give a scene or files, or --rigor estimate");
  const ProgressLine progress(common.quiet);
  const validate::ChooseAnswer answer = validate::answer(request, stop, progress.report());
  Result result;
  result.inputs = inputs_of(request, answer);
  result.json = json_of(validate::choose_fields(), answer);
  result.text = to_text(answer, common.screen(), {.verbose = options.verbose, .measured = options.analyze});
  result.csv = to_csv(answer, result.inputs, result.json);
  result.stopped = answer.stopped;
  result.answers_at_limit = answer.rigor == Rigor::measure;
  return result;
}

}  // namespace

Command choose_command(CLI::App& program) {
  CLI::App* app = program.add_subcommand("choose", "The fastest technique and its parameters, and why");
  app->footer(
      "Example: detp choose @tree --rays 100000 --disc-radius 1% --analyze\n"
      "Example: detp choose @tree --map --disc-radius 1%,4%,16% -o map.svg");
  const auto options = std::make_shared<ChooseOptions>();
  options->workload.add_to(*app, Values::one, Values::many);
  options->costs.add_to(*app);
  app->add_option("--rigor", options->rigor,
                  "estimate: closed forms only; structural: rays of the same kind through parts of the index; pilot: "
                  "some of the rays themselves; measure: runs of the candidates, until --time-limit; default: pilot, "
                  "where there are rays and the engine is simd");
  app->add_option("--technique", options->technique,
                  "a list of techniques; others are not chosen; default: all exact ones")
      ->delimiter(',');
  app->add_option("--disable", options->disable, "a list of techniques that may not be chosen; default: none")
      ->delimiter(',');
  app->add_option("--engine", options->engine, engine_help);
  app->add_flag("--analyze", options->analyze, "run the candidates: predicted, counted and measured, and the regret");
  add_count(*app, "--ranks", options->ranks,
            "also predict what so many processes (mpirun) take, each with --threads; default: not");
  add_number(*app, "--network", options->network,
             "bytes a second between two processes, for --ranks; default: 1.25e9, 10 Gbit/s");
  app->add_flag("--map", options->map,
                "the fastest technique for each of several --rays and --disc-radius (lists or ranges; default: 1e2 … "
                "3e5 and 0.25% … 16%); with --analyze also measured; -o FILE.svg draws it");
  app->add_flag(
      "--verbose", options->verbose,
      "text with all that JSON has: every candidate, what was ruled out, the paper's rule, evidence of effects, "
      "symbols");
  app->add_option("--checkpoint", options->checkpoint,
                  "with --map and --analyze: keep the measured cells in this file; default: none");
  app->add_flag("--resume", options->resume, "go on from the checkpoint; default: begin anew");
  return {app,
          [options](const CommonOptions& common, const std::stop_token& stop) {
            return run_choose(*options, common, stop);
          },
          false, validate::describe_choose() + validate::describe_map()};
}

}  // namespace detp::cli
