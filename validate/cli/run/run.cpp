#include <fmt/format.h>

#include <stdexcept>

#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/model/vocabulary/nearest_name.hpp"
#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/validate/base/search_work.hpp"
#include "detp/validate/choice/choice.hpp"
#include "detp/validate/cli/command.hpp"
#include "detp/validate/cli/options/candidate_options.hpp"
#include "detp/validate/cli/options/cost_options.hpp"
#include "detp/validate/cli/options/workload_options.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/stopping/job_batches.hpp"
#include "run_report.hpp"
#include "run_until.hpp"
#include "timed_run.hpp"

namespace detp::cli {
namespace {

struct RunOptions {
  WorkloadOptions workload;
  CandidateOptions candidate;
  std::optional<std::string> estimator;
  std::optional<double> paths;        ///< of gather
  std::optional<std::uint64_t> seed;  ///< of a row, by --seeds
  CostOptions costs;
  int repeat = 0;
  std::optional<std::string> per_disc;
  bool standard_error = false;
  std::optional<std::string> pairs;
  bool verbose = false;
  TargetOptions target;
  std::optional<std::string> share;
  std::optional<std::string> form;
};

sim::Estimator parse_estimator(const std::string& text) {
  std::vector<std::string_view> names;
  for (const sim::EstimatorRecord& one : sim::estimators) {
    if (text == one.name) return one.estimator;
    names.push_back(one.name);
  }
  throw std::invalid_argument(fmt::format("there is no estimator {}; there are {}{}", detp::quoted(text),
                                          fmt::join(names, ", "), did_you_mean(text, names)));
}

/// The estimator of a row. The technique photon-map is another name of the estimator `nearest`, which gets its parameters.
/// Throws std::invalid_argument for an estimator with the technique of another.
sim::Estimator estimator_of(const RunOptions& options) {
  const bool photon_map = options.candidate.technique_or(Technique::brute_force) == Technique::photon_map;
  if (!options.estimator) return photon_map ? sim::Estimator::nearest : sim::Estimator::disc;
  const sim::Estimator estimator = parse_estimator(*options.estimator);
  const bool searches = sim::record_of(estimator).finds_pairs;
  if (options.candidate.technique && searches == photon_map && !(photon_map && estimator == sim::Estimator::nearest))
    throw std::invalid_argument(fmt::format("the estimator {} does not use {}: leave out --technique or --estimator",
                                            name(estimator), *options.candidate.technique));
  if (options.candidate.technique && !searches && estimator != sim::Estimator::nearest)
    throw std::invalid_argument(
        fmt::format("the estimator {} searches no pairs: leave out --technique", name(estimator)));
  return estimator;
}

/// Of gather; 0 of other estimators.
std::uint64_t paths_of(const RunOptions& options, sim::Estimator estimator) {
  if (!sim::record_of(estimator).needs_scene) return 0;
  const double paths = options.paths.value_or(static_cast<double>(sim::paths_by_default));
  require_count("--paths", paths, 1, 4294967296);
  return static_cast<std::uint64_t>(paths);
}

/// The number of threads, at most `most_threads`, on which the closed form predicts the candidate to be fastest.
int chosen_threads(const Candidate& candidate, const Workload& workload, const CostTable& costs, int most_threads) {
  try {
    return model::assess(workload, candidate, costs, most_threads).threads;
  } catch (const std::invalid_argument&) {  // no closed form for these parameters
    return most_threads;
  }
}

/// Returns the requested technique on `threads` threads, or the technique that the closed forms predict to be fastest, on
/// at most so many. The closed forms also choose the parameters that the options leave open. The job is measured only if they choose.
Requested complete(const CandidateOptions& options, const validate::Job& job, const CostTable& costs, int threads) {
  if (options.technique && !options.stop) {
    const Technique given = options.technique_or(Technique::brute_force);
    const model::FixedParameters fixed = options.fixed_parameters(given);
    if (!model::is_open(given, fixed)) return {candidate_with(given, fixed), sim::thread_count(threads)};
  }
  const Workload& workload = job.workload();
  const int most = sim::useful_threads(threads);
  const Technique technique =
      options.technique ? options.technique_or(Technique::brute_force)
                        : validate::choose({.workload = workload, .threads = most}, costs).best().candidate.technique;
  const model::FixedParameters fixed = options.fixed_parameters(technique);
  auto candidate = model::complete(technique, fixed, workload, costs);
  if (!candidate) throw std::length_error(fmt::format("{} would not fit in memory on this workload", name(technique)));
  if (auto* cache = std::get_if<SphereCacheParameters>(&candidate->parameters);
      cache != nullptr && options.stop == SphereStop::max)
    cache->spheres = model::sphere_stops(workload, costs[technique], Form::corrected, {cache->ratio}).max;
  return {*candidate,
          options.technique ? sim::thread_count(threads) : chosen_threads(*candidate, workload, costs, most)};
}

/// The same for any estimator: those that search no pairs have no technique, and run on `threads` threads.
Requested requested(const CandidateOptions& options, sim::Estimator estimator, const validate::Job& job,
                    const CostTable& costs, int threads) {
  if (sim::record_of(estimator).finds_pairs) return complete(options, job, costs, threads);
  if (estimator != sim::Estimator::nearest) return {{}, sim::thread_count(threads)};
  return {model::candidate_with(Technique::photon_map, options.fixed_parameters(Technique::photon_map)),
          sim::thread_count(threads)};
}

/// What the options name and the candidate is not, as "leaf 16"; empty if it is all of it.
std::string missing_in(const Candidate& candidate, const CandidateOptions& options) {
  if (const Technique asked = options.technique_or(candidate.technique); asked != candidate.technique)
    return std::string(name(asked));
  for (const auto& asked : options.fixed_parameters(candidate.technique).values)
    if (find_parameter(candidate.technique, asked.first)->get(candidate.parameters) != asked.second)
      return std::visit([&](const auto& one) { return fmt::format("{} {}", asked.first, one); }, asked.second);
  return "";
}

/// Nothing if the option is not set. Throws std::invalid_argument for an unknown name.
std::optional<sim::Share> share_of(const RunOptions& options) {
  if (!options.share) return std::nullopt;
  return one_of("--share", *options.share, {"rays", "discs"}) == "rays" ? sim::Share::rays : sim::Share::discs;
}

sim::EstimateRequest request_of(const RunAnswer& answer, const validate::Job& job) {
  sim::EstimateRequest request{.estimator = answer.estimator,
                               .candidate = answer.candidate,
                               .mesh = job.scene ? &job.scene->mesh : nullptr,
                               .scene = job.scene.get(),
                               .paths = answer.paths,
                               .seed = job.seed};
  if (const auto* map = std::get_if<PhotonMapParameters>(&answer.candidate.parameters)) {
    request.nearest = map->nearest;
    request.nearest_form = map->form;
  }
  return request;
}

void check_options(const RunOptions& options, std::size_t rows) {
  if (rows > 1 && (options.per_disc || options.pairs))
    throw std::invalid_argument("--per-disc and --pairs write the hits of one run; give one value for each option");
  if (options.standard_error && !options.per_disc)
    throw std::invalid_argument("--standard-error is a column of --per-disc FILE; give that too");
  if (options.target.given()) {
    static_cast<void>(options.target.target());
    if (options.pairs || options.repeat > 0)
      throw std::invalid_argument("a run until an error has no --pairs and --repeat");
  }
  if (!options.target.given() && !options.target.faces.empty())
    throw std::invalid_argument(
        "--material and --group say of which samples the error is: give --target-noise or --target-error");
  static_cast<void>(share_of(options));
  if (options.target.checkpoint && (!options.target.given() || rows > 1))
    throw std::invalid_argument("--checkpoint keeps one run with --target-noise or --target-error");
}

/// Returns the progress if a stop request ended the run, the writing or the timed runs; else nothing.
std::optional<sim::Progress> write_hits(const RunOptions& options, const validate::Job& job, const RunAnswer& answer,
                                        const CommonOptions& common, const std::stop_token& stop) {
  const sim::Outcome& outcome = answer.run.outcome;
  // By the photons so far, the irradiance is an estimate; sums over other rays would be too small.
  const bool is_estimate = outcome.stopped && answer.taken;
  if (outcome.stopped && ((options.per_disc && !is_estimate) || options.pairs))
    note(common, "stopped before the end: --per-disc and --pairs are not written, because they would be partial");
  if (is_estimate && options.per_disc) {
    note(common, fmt::format("{} has the irradiance by the photons of the first {} rays", *options.per_disc,
                             outcome.progress.done));
    write_per_disc(*options.per_disc, answer.run, job.vertices, {});
  }
  if (outcome.stopped) return outcome.progress;
  const bool in_time = !answer.until || answer.until->result.reason != validate::StopReason::time;
  try {
    if (options.per_disc) write_per_disc(*options.per_disc, answer.run, job.vertices, stop);
    if (options.pairs) write_pairs(*options.pairs, answer.run, job.file_order, stop);
  } catch (const sim::Stopped& stopped) {
    note(common, fmt::format("{}; the file is not kept", stopped.what()));
    return stopped.progress();
  }
  if (!in_time) return outcome.progress;
  const std::size_t timed = answer.timing.all.size();
  if (options.repeat > 0 && timed < static_cast<std::size_t>(options.repeat))
    return sim::Progress{timed, static_cast<std::uint64_t>(options.repeat), "timed runs"};
  return std::nullopt;
}

/// Throws std::invalid_argument if a technique has no formulas of the form requested, or none is named.
std::optional<Form> form_of(const RunOptions& options) {
  if (!options.form) return std::nullopt;
  if (options.target.given())
    throw std::invalid_argument("--form changes the predicted counts; a run until an error has none");
  const Form form = choice_named<Form>(*options.form).value();
  if (!options.candidate.technique)
    throw std::invalid_argument("--form is of one technique's formulas: give --technique");
  const Technique technique = options.candidate.technique_or(Technique::sphere_cache);
  if (form == Form::published && !is_published(technique))
    throw std::invalid_argument(
        fmt::format("the paper has no formulas for {}; it has for sphere-cache, sphere-cache-published and octree",
                    name(technique)));
  return form;
}

/// What the estimators of all rows need.
struct Needs {
  bool rays = false;
  bool all_rays = false;  ///< in memory: of estimators that need more than the pairs of a block of rays
  bool scene = false;
  bool paths = false;  ///< backward
};

Needs needs_of(RunOptions& options, std::size_t rows) {
  Needs needs;
  for (std::size_t row = 0; row < rows; ++row) {
    options.candidate.lists.choose_row(row);
    const sim::Estimator estimator = estimator_of(options);
    if (options.target.given()) validate::require_batches(estimator);
    needs.all_rays = needs.all_rays || estimator != sim::Estimator::disc || options.target.given();
    const sim::EstimatorRecord& record = sim::record_of(estimator);
    needs.scene = needs.scene || record.needs_mesh || record.needs_scene || options.target.given();
    needs.paths = needs.paths || record.needs_scene;
    needs.rays = needs.rays || !record.needs_scene;
    static_cast<void>(paths_of(options, estimator));
    static_cast<void>(form_of(options));
  }
  if (options.paths && !needs.paths) throw std::invalid_argument("--paths is for --estimator gather");
  return needs;
}

constexpr double most_rays_by_default = 1e9;  ///< of a run until an error

/// Chooses, and runs the choice with what choosing has sorted.
void choose_and_run(RunAnswer& answer, const validate::Question& question, const CostTable& costs,
                    sim::RunOptions options, const sim::ReportPhase& progress) {
  const sim::Problem& problem = *question.problem;
  answer.choice = validate::choose(question, costs);
  answer.candidate = answer.choice->best().candidate;
  answer.threads = options.threads = answer.choice->best().threads;
  if (progress)
    progress({std::string(name(answer.candidate.technique)), 0, 1,
              validate::search_work(answer.choice->best().counts, options.engine)});
  if (answer.estimator != sim::Estimator::disc) {
    answer.run.outcome = sim::estimate(problem, {answer.estimator, answer.candidate}, options);
    return;
  }
  try {
    answer.run.outcome = sim::run(problem, *validate::build_choice(*answer.choice, problem, options), options);
  } catch (const sim::Stopped&) {  // stopped while the index was built
    answer.run.outcome = sim::unsearched_outcome(problem, options);
  }
}

/// Nothing if the run was stopped before its first ray.
std::optional<RaysTaken> taken_of(const sim::PhotonSource& source, const sim::Outcome& outcome) {
  const std::uint64_t rays = outcome.stopped ? outcome.progress.done : source.size();
  const std::uint64_t photons = source.photons_of(rays);
  if (photons == 0) return std::nullopt;
  return RaysTaken{static_cast<double>(rays), static_cast<double>(photons), source.light_of(photons)};
}

RunAnswer run_one(const RunOptions& options, const validate::Job& job, const CostTable& costs,
                  const CommonOptions& common, const std::stop_token& stop, const sim::ReportPhase& progress) {
  const validate::Question question{.problem = job.stream ? nullptr : &job.problem(),
                                    .effects = job.measuring.effects,
                                    .surface = &job.surface,
                                    .purpose = validate::Purpose::one_search,
                                    .threads = common.threads,
                                    .stop = stop};
  const sim::Estimator estimator = estimator_of(options);
  const bool searches = sim::record_of(estimator).finds_pairs;
  const bool until = options.target.given();
  sim::Ranks* const ranks = job.stream || until ? common.ranks : nullptr;  // that share the search
  if (ranks == nullptr && !common.answers()) return {};
  const bool by_pilot =
      searches && !options.candidate.technique && validate::reachable_rigor(question, costs) == Rigor::pilot;
  const CostTable priced = validate::costs_for(question, costs);
  const auto by_options = [&] { return requested(options.candidate, estimator, job, priced, common.threads); };
  const Requested choice = by_pilot || until ? Requested{} : agreed(ranks, by_options);
  RunAnswer answer{.candidate = choice.candidate,
                   .estimator = estimator,
                   .paths = paths_of(options, estimator),
                   .threads = choice.threads,
                   .costs = priced,
                   .engine = options.candidate.engine,
                   .form = form_of(options),
                   .repeat = options.repeat,
                   .standard_error = options.standard_error,
                   .whole = validate::whole_inputs(options.workload.request(common), job, job.given.rays),
                   .random_rays = !options.workload.request(common).ray_file};
  if (until) {
    const double most_rays = options.workload.request(common).rays.value_or(most_rays_by_default);
    const auto choose = [&]() -> Requested {
      if (!by_pilot) return by_options();
      const validate::Choice chosen = validate::choose(question, priced);
      return {chosen.best().candidate, chosen.best().threads};
    };
    const auto missing = [&](const Candidate& candidate) {
      return searches ? missing_in(candidate, options.candidate) : std::string();
    };
    run_to_target(answer, job, options.target, most_rays, {choose, missing}, common.threads, stop, progress, ranks);
    return answer;
  }
  const Engine engine = options.candidate.engine;
  sim::RunOptions run{.pairs = options.pairs.has_value(),
                      .engine = engine,
                      .stop = stop,
                      .threads = by_pilot ? common.threads : choice.threads};
  run.standard_error = options.standard_error;
  const Together together{ranks, share_of(options)};
  const double share_of_first = 1.0 / (1 + options.repeat);
  if (by_pilot) {
    answer.run.prepare_seconds = job.check_seconds;
    answer.run.rays_in_memory = job.rays.size();
    choose_and_run(answer, question, costs, run, sim::part_of(progress, 0, share_of_first));
  } else {
    answer.run = run_job(job, request_of(answer, job), run, sim::part_of(progress, 0, share_of_first), together);
  }
  if (job.photon_stream && common.answers()) answer.taken = taken_of(*job.photon_stream, answer.run.outcome);
  run.threads = answer.threads;
  run.count = run.pairs = false;
  answer.timing = time_runs(job, request_of(answer, job), answer.run, answer.run.outcome.stopped ? 0 : options.repeat,
                            run, sim::part_of(progress, share_of_first, 1), together);
  return answer;
}

/// Divides the progress among the rows of a table. A scene with its rays is expected to take a constant time (for scene
/// and index) plus a term proportional to the number of rays.
class RowProgress {
 public:
  RowProgress(RunOptions& options, const CommonOptions& common) : candidates_(options.candidate.lists.rows()) {
    ValueLists& problems = options.workload.lists;
    for (std::size_t i = 0; i < problems.rows(); ++i) {
      problems.choose_row(i);
      ends_.push_back((ends_.empty() ? 0 : ends_.back()) + options.workload.request(common).rays.value_or(1e5) + 3e4);
    }
  }

  sim::ReportPhase job(sim::ReportPhase whole) {
    const double begin = row_ < candidates_ ? 0 : ends_[row_ / candidates_ - 1];
    const double length = ends_[row_ / candidates_] - begin;
    after_job_ = begin + length * share_of_job;
    return sim::part_of(std::move(whole), begin / ends_.back(), after_job_ / ends_.back());
  }

  sim::ReportPhase next(sim::ReportPhase whole) {
    const double each = (ends_[row_ / candidates_] - after_job_) / static_cast<double>(candidates_);
    const double begin = after_job_ + each * static_cast<double>(row_++ % candidates_);
    return sim::part_of(std::move(whole), begin / ends_.back(), (begin + each) / ends_.back());
  }

 private:
  static constexpr double share_of_job = 0.3;

  std::size_t candidates_;
  std::vector<double> ends_;  ///< for each problem: the sum of the expected times up to its end
  std::size_t row_ = 0;
  double after_job_ = 0;
};

Result run_run(RunOptions& options, const CommonOptions& common, const std::stop_token& stop) {
  require_count("--repeat", options.repeat, 0, 10000);
  ValueLists& problems = options.workload.lists;
  ValueLists& candidates = options.candidate.lists;
  const std::size_t expected = rows_in(problems, candidates);
  check_options(options, expected);
  const Needs needs = needs_of(options, candidates.rows());
  const CostsInUse costs = options.costs.costs(common);
  const ProgressLine progress(common.quiet);
  RowProgress rows(options, common);
  // Short text shows nothing that has to be measured.
  const bool is_short = common.format == "text" && expected == 1 && !options.verbose;
  Json inputs;
  std::string text;
  std::optional<sim::Progress> stopped;
  bool not_reached = false;
  bool predicted = false;
  const auto prepare = [&] {
    validate::JobRequest request = options.workload.request(common);
    if (options.seed) request.seed = *options.seed;
    if (options.target.given() && !request.ray_file) request.rays = first_rays(request.rays);
    request.stream = request.store_discs = !needs.all_rays;
    request.keep_scene = needs.scene;
    request.without_rays = !needs.rays;
    request.in_batches = options.target.given();
    request.ranks = common.ranks;
    validate::Job job = validate::make_job(request, stop, rows.job(progress.report()));
    note_all(common, job);
    if (options.standard_error && request.ray_file && !job.numbered())
      note(common, "standard errors: the rays have no column photon, so each ray counts as a photon of its own");
    if (!is_short && common.answers()) inputs = to_json(job, request);
    return job;
  };
  const auto answer = [&](const validate::Job& job) {
    const RunAnswer found =
        run_one(options, job, costs.of(options.candidate.engine), common, stop, rows.next(progress.report()));
    if (!common.answers()) return AnswerRow{};
    for (const std::string& one : answer_warnings(job, found)) note(common, "warning: " + one);
    if (found.until && found.until->mirror_share > 0) note(common, validate::mirror_notice(found.until->mirror_share));
    stopped = write_hits(options, job, found, common, stop);
    not_reached = found.until && found.until->result.reason != validate::StopReason::target;
    if (expected == 1) text = to_text(job, found, common.screen(), options.verbose);
    if (is_short) return AnswerRow{Json::object(), {{"stopped", found.run.outcome.stopped}}, {Json::object()}};
    inputs["engine"] = name(options.candidate.engine);
    inputs["threads"] = sim::thread_count(common.threads);  // a cap if the command chooses
    inputs["repeat"] = options.repeat;
    inputs["form"] = options.form ? Json(*options.form) : Json();
    inputs.erase("paths");  // of the row before
    if (gathers(found)) inputs["paths"] = found.paths;
    if (options.target.given()) {
      inputs["materials"] = options.target.faces.materials;
      inputs["groups"] = options.target.faces.groups;
      inputs["target_noise"] = options.target.noise ? Json(found.until->target) : Json();
      inputs["target_error"] = options.target.error ? Json(found.until->target) : Json();
      if (!options.workload.request(common).ray_file)
        inputs["rays"] = options.workload.request(common).rays.value_or(most_rays_by_default);
    }
    AnswerRow row = run_row(inputs, job, found, expected == 1);
    predicted = predicted || row.answer.contains("predicted_seconds");
    return row;
  };
  const std::vector<AnswerRow> answers = answer_all(problems, candidates, stop, prepare, answer);
  if (!common.answers()) return {};
  if (predicted) note_doubt(costs, common);
  Result result = result_of(answers, expected, run_columns(), run_text_columns(common.screen()));
  if (expected == 1) {
    result.text = text;
    result.stopped = stopped;
    result.not_reached = not_reached && !stopped;
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
  app->add_option("--per-disc", options->per_disc,
                  "write disc,hits,irradiance as CSV, in input order, and the vertex in the mesh (-1: none)");
  app->add_flag("--standard-error", options->standard_error,
                "add to --per-disc the standard error of each irradiance, for independent photons, and where a few "
                "photons bring most of it, an upper bound (95 %) of the irradiance");
  app->add_option("--pairs", options->pairs, "write the hits as CSV ray,disc");
  app->add_option("--target-noise", options->target.noise,
                  "run until the noise (root mean square over the discs by area, relative to the root mean square "
                  "irradiance) is smaller, as 5%; --rays is then the limit (1e9); default: not");
  app->add_option("--target-error", options->target.error,
                  "the same of noise and bias together; the bias comes from a pilot; default: not");
  add_face_names(*app, options->target.faces);
  app->add_option("--confidence", options->target.confidence, "that the noise of this run is smaller; default: 95%");
  app->add_option("--checkpoint", options->target.checkpoint,
                  "with a target: keep in this file what is found, so that the run can be killed; default: none");
  app->add_flag("--resume", options->target.resume, "go on from the checkpoint; default: begin anew");
  return {
      app,
      [options](const CommonOptions& common, const std::stop_token& stop) { return run_run(*options, common, stop); },
      true};
}

}  // namespace detp::cli
