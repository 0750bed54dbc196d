#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/files/table_writer.hpp"
#include "detp/validate/accuracy/judged_samples.hpp"
#include "detp/validate/cli/command.hpp"
#include "detp/validate/cli/options/candidate_options.hpp"
#include "detp/validate/cli/options/cost_options.hpp"
#include "detp/validate/cli/options/number_option.hpp"
#include "detp/validate/cli/options/workload_options.hpp"
#include "detp/validate/cli/report/answer_rows.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/run/run_fields.hpp"
#include "run_text.hpp"

namespace detp::cli {
namespace {

using validate::RunAnswer;
using validate::RunRequest;

const sim::Stopwatch since_start;  // since the program was loaded

struct RunOptions {
  WorkloadOptions workload;
  CandidateOptions candidate;
  std::optional<std::string> estimator;
  std::optional<double> paths;        ///< of gather
  std::optional<std::uint64_t> seed;  ///< of a row, by --seeds
  CostOptions costs;
  int repeat = 0;
  bool standard_error = false;
  validate::RunFiles files;
  std::optional<std::string> picture;
  std::optional<std::string> view;
  std::optional<std::string> picture_scale;
  int picture_width = validate::Picture::usual_width;
  bool verbose = false;
  std::optional<std::string> target_noise;
  std::optional<std::string> target_error;
  std::string confidence = "95%";
  std::optional<std::string> noise_of;
  validate::RunTarget target;  ///< its faces and checkpoint
  std::optional<std::string> share;
  std::optional<std::string> form;
};

/// Nothing without a target.
std::optional<validate::RunTarget> target_of(const RunOptions& options) {
  if (options.target_noise && options.target_error)
    throw std::invalid_argument("give one of --target-noise and --target-error");
  validate::RunTarget target = options.target;
  if (!options.target_noise && !options.target_error) {
    if (!target.faces.empty())
      throw std::invalid_argument(
          "--material and --group say of which samples the error is: give --target-noise or --target-error");
    if (options.noise_of)
      throw std::invalid_argument("--noise-of says whose error is meant: give --target-noise or --target-error");
    if (target.checkpoint)
      throw std::invalid_argument("--checkpoint keeps one run with --target-noise or --target-error");
    return std::nullopt;
  }
  target.total = options.target_error.has_value();
  if (options.noise_of != "all") target.band = options.noise_of;
  target.error.confidence = parse_share("--confidence", options.confidence);
  target.error.error = target.total ? parse_share("--target-error", *options.target_error)
                                    : parse_share("--target-noise", *options.target_noise);
  return target;
}

/// Nothing without a picture.
std::optional<validate::Picture> picture_of(const RunOptions& options) {
  if (!options.picture) {
    if (options.view || options.picture_scale || options.picture_width != validate::Picture::usual_width)
      throw std::invalid_argument(
          "--view, --picture-scale and --picture-width belong to a picture: give --picture FILE");
    return std::nullopt;
  }
  validate::Picture picture{*options.picture};
  require_count("--picture-width", options.picture_width, 20, 4000);
  picture.width = options.picture_width;
  if (options.picture_scale)
    picture.scaling =
        std::ranges::find(validate::named_scalings, std::string_view(*options.picture_scale), [](const auto& one) {
          return one.first;
        })->second;
  if (!options.view) return picture;
  const std::vector<std::string> words = words_of(*options.view);
  if (words.size() != 6)
    throw std::invalid_argument(
        fmt::format("--view takes six numbers, x,y,z of where to look from and of where to look to (got {})",
                    detp::quoted(*options.view)));
  std::array<double, 6> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = parse_number("--view", words[i]);
  picture.view.emplace(glm::dvec3{numbers[0], numbers[1], numbers[2]}, glm::dvec3{numbers[3], numbers[4], numbers[5]});
  return picture;
}

/// The parameters that mean something to the row: all of a technique that is named; else those that may be chosen, or are the estimator's.
model::FixedParameters parameters_of(const RunOptions& options, const RunRequest& request) {
  if (request.technique && request.technique != Technique::photon_map)
    return options.candidate.fixed_parameters(*request.technique);
  model::FixedParameters fixed = options.candidate.given();
  std::erase_if(fixed.values, [&](const auto& one) {
    if (request.estimator == sim::Estimator::nearest)
      return find_parameter(Technique::photon_map, one.first) == nullptr;
    return !request.searches() || std::ranges::none_of(exact_techniques, [&](Technique technique) {
      return find_parameter(technique, one.first) != nullptr;
    });
  });
  return fixed;
}

/// The request of the current row. The technique photon-map is another name of the estimator `nearest`, which gets its parameters.
RunRequest request_of(const RunOptions& options, const CommonOptions& common) {
  RunRequest request{.job = options.workload.request(common)};
  request.job.ranks = common.ranks;
  if (options.seed) request.job.seed = *options.seed;
  if (options.candidate.technique) request.technique = options.candidate.technique_or(Technique::brute_force);
  request.estimator = options.estimator                            ? parse_estimator(*options.estimator)
                      : request.technique == Technique::photon_map ? sim::Estimator::nearest
                                                                   : sim::Estimator::disc;
  request.parameters = parameters_of(options, request);
  request.most_spheres = options.candidate.stop == SphereStop::max;
  request.engine = options.candidate.engine;
  const double paths = options.paths.value_or(static_cast<double>(sim::paths_by_default));
  require_count("--paths", paths, 1, 4294967296);
  request.paths = static_cast<std::uint64_t>(paths);
  if (options.form) request.form = choice_named<Form>(*options.form);
  request.repeat = options.repeat;
  request.pairs = options.files.pairs.has_value();
  request.standard_error = options.standard_error;
  if (options.files.per_disc) {
    const std::string suffix = sim::suffix_of(*options.files.per_disc);
    request.keep_scene = suffix == ".ply" || suffix == ".vtp";
  }
  if (options.picture || common.in_memory) request.keep_scene = true;
  request.faces = options.files.per_face.has_value();
  request.target = target_of(options);
  if (options.share)
    request.share =
        one_of("--share", *options.share, {"rays", "discs"}) == "rays" ? sim::Share::rays : sim::Share::discs;
  return request;
}

/// Throws std::invalid_argument for options that exclude each other, and for those that no row uses.
void check_options(const RunOptions& options, const std::vector<RunRequest>& candidates, std::size_t rows,
                   bool in_memory) {
  if (rows > 1 && (options.files.per_disc || options.files.per_face || options.files.pairs || options.picture))
    throw std::invalid_argument(
        "--per-disc, --per-face, --pairs and --picture are of one run; give one value for each option");
  if (rows > 1 && in_memory) throw std::invalid_argument("one run is kept in memory; give one value for each option");
  if (options.standard_error && !options.files.per_disc && !options.files.per_face && !options.picture && !in_memory)
    throw std::invalid_argument(
        "--standard-error is for files of results: give --per-disc FILE, --per-face FILE or --picture FILE too");
  if (options.target.checkpoint && rows > 1)
    throw std::invalid_argument("--checkpoint keeps one run with --target-noise or --target-error");
  std::set<std::string_view> used;
  for (const RunRequest& one : candidates) {
    check(one);
    for (const auto& parameter : one.parameters.values) used.insert(parameter.first);
  }
  for (const auto& parameter : options.candidate.given().values)
    if (!used.contains(parameter.first))
      throw std::invalid_argument(
          fmt::format("--{} is a parameter of no technique that may run here", parameter.first));
  if (options.paths && std::ranges::none_of(candidates, &RunRequest::gathers))
    throw std::invalid_argument("--paths is for --estimator gather");
}

/// The requests of the rows of one problem.
std::vector<RunRequest> candidates_of(RunOptions& options, const CommonOptions& common) {
  std::vector<RunRequest> all;
  for (std::size_t row = 0; row < options.candidate.lists.rows(); ++row) {
    options.candidate.lists.choose_row(row);
    all.push_back(request_of(options, common));
  }
  return all;
}

/// A scene with its rays is expected to take a constant time (for scene and index) plus a term proportional to the number of rays.
std::vector<double> work_of_problems(RunOptions& options, const CommonOptions& common) {
  std::vector<double> work;
  for (std::size_t i = 0; i < options.workload.lists.rows(); ++i) {
    options.workload.lists.choose_row(i);
    work.push_back(options.workload.request(common).rays.value_or(1e5) + 3e4);
  }
  return work;
}

/// The resolved inputs; those of the job are there.
void add_inputs(Json& inputs, const RunRequest& request) {
  inputs["engine"] = name(request.engine);
  inputs["threads"] = sim::thread_count(request.job.threads);  // a cap if the command chooses
  inputs["repeat"] = request.repeat;
  inputs["form"] = request.form ? Json(name(*request.form)) : Json();
  inputs.erase("paths");  // of the row before
  if (request.gathers()) inputs["paths"] = request.paths;
  if (!request.target) return;
  const validate::RunTarget& target = *request.target;
  inputs["materials"] = target.faces.materials;
  inputs["groups"] = target.faces.groups;
  inputs["target_noise"] = target.total ? Json() : Json(target.error.error);
  inputs["target_error"] = target.total ? Json(target.error.error) : Json();
  if (target.band) inputs["noise_of"] = *target.band;
  if (!request.job.ray_file) inputs["rays"] = request.job.rays.value_or(validate::most_rays_by_default);
}

TextColumns run_text_columns(const Screen& screen) {
  return {{"scene", "field", "ray_file", "front_facing", "seed", "rays", "samples", "disc_radius", "estimator", "paths",
           "engine", "technique", "parameters"},
          {"hits", "rebuild_time", "predicted_rebuild_time", "intersect_time", "predicted_intersect_time", "seconds",
           "predicted_seconds"},
          screen,
          "rebuild_time: T_R at t = 1, tests of rays against spheres or boxes. intersect_time: T_I at u = 1, tests "
          "against discs. Both as in detp model, whose unit costs are 1."};
}

Result run_run(RunOptions& options, const CommonOptions& common, const std::stop_token& stop) {
  require_count("--repeat", options.repeat, 0, 10000);
  ValueLists& problems = options.workload.lists;
  ValueLists& candidates = options.candidate.lists;
  const std::size_t expected = rows_in(problems, candidates);
  problems.choose_row(0);
  options.files.picture = picture_of(options);
  check_options(options, candidates_of(options, common), expected, common.in_memory);
  const CostsInUse costs = options.costs.costs(common);
  const ProgressLine progress(common.quiet);
  RowProgress rows(work_of_problems(options, common), candidates.rows());
  // Short text shows nothing that has to be measured.
  const bool is_short = common.format == "text" && expected == 1 && !options.verbose;
  Json inputs;
  std::string text;
  std::optional<sim::Progress> stopped;
  bool not_reached = false;
  bool predicted = false;
  std::vector<std::string> bands;
  std::shared_ptr<const validate::JobAndRun> kept;
  const auto prepare = [&] {
    const validate::JobRequest request = validate::job_request(candidates_of(options, common));
    auto job = std::make_shared<validate::Job>(validate::make_job(request, stop, rows.job(progress.report())));
    note_all(common, *job);
    bands = job->bands;
    if (options.standard_error && request.ray_file && !job->numbered())
      note(common, "standard errors: the rays have no column photon, so each ray counts as a photon of its own");
    if (!is_short && common.answers()) inputs = to_json(*job, request);
    return job;
  };
  const auto answer = [&](const std::shared_ptr<validate::Job>& shared) {
    const validate::Job& job = *shared;
    RunRequest request = request_of(options, common);
    request.costs = costs.of(request.engine);
    RunAnswer found = validate::answer(job, request, stop, rows.next(progress.report()));
    if (!common.answers()) return AnswerRow{};
    for (const std::string& one : answer_warnings(job, found)) note(common, "warning: " + one);
    if (found.until && found.until->mirror_share > 0) note(common, validate::mirror_notice(found.until->mirror_share));
    const validate::WrittenRun written = write_files(options.files, job, found, stop);
    for (const std::string& notice : written.notices) note(common, notice);
    stopped = written.stopped;
    not_reached = found.until && found.until->result.reason != validate::StopReason::target;
    const validate::Whole measured = measured_whole(job, found, since_start.seconds());
    if (expected == 1) text = to_text(job, found, measured, common.screen(), options.verbose);
    if (written.picture) text += picture_text(*options.files.picture, *written.picture, common.screen());
    if (is_short) return AnswerRow{Json::object(), {{"stopped", found.run.outcome.stopped}}, {Json::object()}};
    add_inputs(inputs, request);
    validate::ShownRun shown = validate::shown_run(job, found, expected == 1 ? std::optional(measured) : std::nullopt);
    shown.picture = written.picture;
    AnswerRow row{inputs, json_of(validate::run_fields(), shown), {workload_cells(inputs)}};
    row.cells.front().update(cells_of(validate::run_fields(), shown, row.answer));
    predicted = predicted || row.answer.contains("predicted_seconds");
    if (common.in_memory)
      kept = std::make_shared<validate::JobAndRun>(validate::JobAndRun{std::move(*shared), std::move(found)});
    return row;
  };
  const std::vector<AnswerRow> answers = answer_all(problems, candidates, stop, prepare, answer);
  if (!common.answers()) return {};
  if (predicted) note_doubt(costs, common);
  Columns columns = validate::united(workload_columns(), columns_of(validate::run_fields()));
  for (const std::string& band : bands)
    for (const char* of : {"mean_irradiance_", "mean_irradiance_error_"}) columns.push_back(of + band);
  Result result = result_of(answers, expected, columns, run_text_columns(common.screen()));
  if (expected == 1) {
    result.text = text;
    result.stopped = stopped;
    result.not_reached = not_reached && !stopped;
    result.run = std::move(kept);
  }
  return result;
}

}  // namespace

Command run_command(CLI::App& program) {
  CLI::App* app = program.add_subcommand("run", "The hits and the irradiance, by one technique");
  app->footer(
      "Example: detp run @cornell --target-noise 5%\n"
      "Numbers and names may be lists, numbers ranges, as 1%,2%,4% and 0.3:0.9:0.05: every combination makes a row.\n"
      "Example: detp run @tree --rays 100000 --technique octree --per-disc irradiance.csv");
  const auto options = std::make_shared<RunOptions>();
  options->workload.add_to(*app, Values::many);
  options->workload.lists.add(
      *app, "--seeds", Values::many, ValueLists::Kind::seeds,
      [raw = options.get()](const std::string& text) { raw->seed = parse_seed("--seeds", text); },
      "a row for each of these seeds, as 1:100; default: --seed alone");
  options->candidate.add_to(*app, Values::many, SphereStop::best);
  options->candidate.lists.add(
      *app, "--estimator", Values::many, ValueLists::Kind::words,
      [raw = options.get()](const std::string& text) { raw->estimator = text; },
      "disc: rays through discs, found by a technique; variable-radius: the same, with a radius for each disc from the "
      "rays "
      "nearby; nearest: the nearest photons (--nearest); area-corrected: photons near a sample, over the area of the "
      "surfaces "
      "there; triangle-hits: photons of a triangle, over its area; gather: paths from the sample to the lights, "
      "without "
      "photons, radius and bias (--paths); default: disc");
  options->candidate.lists.add_count(*app, "--paths", Values::many, options->paths,
                                     "of gather: how many paths start at each disc, on each side that counts, as 1k; "
                                     "default: 64");
  options->candidate.lists.add_word(*app, "--form", Values::many, options->form, {"published", "corrected"},
                                    "formulas that predict the counts, beside those counted: published (the paper's; "
                                    "of sphere caches and the octree) or corrected; default: corrected");
  options->costs.add_calibration_to(*app);
  app->add_option("--share", options->share,
                  "what several processes share, rays or discs; default: rays, or discs if they do not fit in memory");
  app->add_flag("--verbose", options->verbose,
                "also print effects, and the counts with their predictions; default: a short answer");
  add_number(*app, "--repeat", options->repeat,
             "time that many further runs, which do not count; the median is shown; default: 0");
  app->add_option(
      "--per-disc", options->files.per_disc,
      "write place, hits and irradiance of each disc, in input order, and its vertex in the mesh (-1: none), as "
      ".csv, .ply, .vtp (ParaView) or .npy; .ply and .vtp have the mesh if each vertex has a disc");
  app->add_option(
      "--per-face", options->files.per_face,
      "write area, material, group and the light that lands on each triangle of the scene, in the same formats");
  app->add_flag(
      "--standard-error", options->standard_error,
      "add to files and pictures the standard error of each irradiance, for independent photons, and where a few "
      "photons bring most of it, an upper bound (95 %) of the irradiance");
  app->add_option("--pairs", options->files.pairs, "write the hits as CSV ray,disc");
  app->add_option("--picture", options->picture,
                  "draw the surface in the colours of its irradiance, as .png or .svg; with --standard-error also the "
                  "relative standard error; default: no picture");
  app->add_option(
      "--view", options->view,
      "of the picture: where to look from and to, as x,y,z,x,y,z; default: what shows the most light, a plan "
      "of a flat scene");
  app->add_option("--picture-scale", options->picture_scale,
                  "of the picture's colours: linear, log or auto; default: auto, log if the light differs much")
      ->check(CLI::IsMember({"auto", "linear", "log"}));
  add_number(*app, "--picture-width", options->picture_width,
             "of the picture without its bar, in pixels; default: 800");
  app->add_option("--target-noise", options->target_noise,
                  "run until the noise (root mean square over the discs by area, relative to the root mean square "
                  "irradiance) is smaller, as 5%; --rays is then the limit (1e9); default: not");
  app->add_option("--target-error", options->target_error,
                  "the same of noise and bias together; the bias comes from a pilot; default: not");
  app->add_option(
      "--noise-of", options->noise_of,
      "with a target and several bands: the band whose error is meant, or all, for their sum; default: all");
  add_face_names(*app, options->target.faces);
  app->add_option("--confidence", options->confidence, "that the noise of this run is smaller; default: 95%");
  app->add_option("--checkpoint", options->target.checkpoint,
                  "with a target: keep in this file what is found, so that the run can be killed; default: none");
  app->add_flag("--resume", options->target.resume, "go on from the checkpoint; default: begin anew");
  return {
      app,
      [options](const CommonOptions& common, const std::stop_token& stop) { return run_run(*options, common, stop); },
      true, describe_fields(validate::run_fields())};
}

}  // namespace detp::cli
