#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "choose_map.hpp"
#include "choose_report.hpp"
#include "detp/model/rank/paper_rule.hpp"
#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/technique/piloted_discs.hpp"
#include "detp/validate/choice/tips.hpp"
#include "detp/validate/cli/command.hpp"
#include "detp/validate/cli/options/candidate_options.hpp"
#include "detp/validate/cli/options/cost_options.hpp"
#include "detp/validate/cli/options/workload_options.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/progress_line.hpp"
#include "detp/validate/structural/structural.hpp"

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
  RanksOptions ranks;
};

/// The standard error of the choice's predicted seconds, as far as it is known.
double search_error(const ChooseAnswer& answer) {
  const Prediction& best = answer.choice.best();
  return answer.by_sample() ? best.error : best.time.total() * answer.costs.relative_error_of(best.candidate.technique);
}

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

/// Throws std::invalid_argument if the predicted times cannot be compared. Adds the candidate of the paper's rule, and brute force.
void check_ranking(ChooseAnswer& answer, const CostTable& costs, int threads) {
  const double fastest = answer.choice.best().time.total();
  if (!(fastest > 0))
    throw std::invalid_argument(fmt::format(
        "with these unit costs {} takes no time, so that nothing can be compared: {} cost 0; give every operation its "
        "cost in seconds, as --help explains",
        name(answer.choice.best().candidate.technique), zero_costs(costs[answer.choice.best().candidate.technique])));
  if (!std::isfinite(answer.choice.candidates.back().time.total()))
    throw std::invalid_argument(
        fmt::format("with these unit costs the time of {} exceeds 1.8e308 s and cannot be compared; give smaller costs",
                    name(answer.choice.candidates.back().candidate.technique)));
  answer.paper = model::assess(answer.workload, model::paper_rule(answer.workload), costs, threads);
  answer.brute_force =
      model::assess(answer.workload, {Technique::brute_force, BruteForceParameters{}}, costs, threads).time.again();
}

/// The progress if a stop request ended the search for tips, else nothing.
std::optional<sim::Progress> stopped_tips(const ChooseAnswer& answer) {
  if (!answer.tips.stopped()) return std::nullopt;
  return sim::Progress{answer.tips.inputs, answer.tips.ranges.size(), "inputs examined for tips"};
}

/// Chooses, and finds tips. Returns the progress if a stop request ended the ranking or the search for tips, else nothing.
/// Throws sim::Stopped if it ended a pilot.
std::optional<sim::Progress> decide(ChooseAnswer& answer, const validate::Question& question, const CostTable& costs) {
  answer.choice = validate::choose(question, costs);
  answer.rigor = answer.choice.rigor;
  answer.choosing_seconds = answer.evidence_seconds + answer.choice.choosing_seconds;
  check_ranking(answer, validate::costs_for(question, costs), question.threads);
  const sim::Stopwatch watch;
  answer.tips = validate::tips_of(answer.choice, question, costs);
  answer.tips_seconds = watch.seconds();
  const auto all = std::ranges::count_if(
      exact_techniques, [&](Technique one) { return model::has_closed_form(one) && question.allows(one); });
  if (answer.by_sample() || !question.stop.stop_requested() || std::ssize(answer.choice.candidates) >= all)
    return stopped_tips(answer);
  return sim::Progress{answer.choice.candidates.size(), static_cast<std::uint64_t>(all), "techniques ranked"};
}

Prediction priced(const Candidate& candidate, const Counts<double>& counts, const CostTable& costs, int threads) {
  const TimeOnThreads fastest = fastest_price(counts, costs, candidate.technique, threads);
  return {.candidate = candidate, .counts = counts, .time = fastest.time, .threads = fastest.threads};
}

Prediction assess_structurally(const validate::Job& job, const Candidate& candidate, const CostTable& costs,
                               int threads, const std::stop_token& stop) {
  const Counts<double> counts =
      validate::structural_counts(job.discs, job.given.rays, candidate, stop, job.front_facing, costs.engine);
  return priced(candidate, counts, costs, threads);
}

/// The prediction from structural counts (of isotropic lines) if `structural`, otherwise from the closed form. Returns
/// nothing if the candidate has no such prediction, if its index does not fit in memory, or if a stop was requested.
std::optional<Prediction> predicted(const Candidate& candidate, const validate::Job& job, bool structural,
                                    const CostTable& costs, int threads, const std::stop_token& stop) {
  try {
    return structural ? assess_structurally(job, candidate, costs, threads, stop)
                      : model::assess(job.workload(), candidate, costs, threads);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  } catch (const std::length_error&) {
    return std::nullopt;
  } catch (const sim::Stopped&) {
    return std::nullopt;
  }
}

/// The pilot's prediction of a box tree; of any other candidate that of its closed form.
std::optional<Prediction> predicted_by_pilot(const Candidate& candidate, const validate::Choice& choice,
                                             const validate::Job& job, bool structural, const CostTable& costs,
                                             int threads, const std::stop_token& stop) {
  if (candidate.technique != Technique::box_tree || !choice.discs)
    return predicted(candidate, job, structural && job.field == sim::Field::isotropic, costs, threads, stop);
  const auto counts = choice.discs->counts(std::get<BoxTreeParameters>(candidate.parameters)).counts;
  return priced(candidate, counts, costs, threads);
}

sim::Progress measured(const validate::Analysis& analysis) {
  const auto done = std::count_if(analysis.candidates.begin(), analysis.candidates.end(),
                                  [](const validate::Analysed& one) { return one.seconds.has_value(); });
  return {static_cast<std::uint64_t>(done), analysis.candidates.size(), "candidates measured"};
}

std::string describe_numbers(const Workload& workload) {
  return fmt::format("workload  {:.6g} rays, {:.6g} samples, discs of radius d = {:.4g}, r0 = {:.4g}, D = {:.2f}\n",
                     workload.rays, workload.samples, workload.disc_radius, workload.sphere_radius, workload.dimension);
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

void check_options(const ChooseOptions& options) {
  if (options.map && options.ranks.ranks) throw std::invalid_argument("--ranks is for one workload, not for --map");
  if (options.ranks.ranks) require_count("--ranks", *options.ranks.ranks, 1, 1e6);
  require_positive("--network", options.ranks.bytes_per_second);
  if (options.checkpoint && !(options.map && options.analyze))
    throw std::invalid_argument("--checkpoint keeps the measured cells of --map with --analyze");
}

Result run_choose(ChooseOptions& options, const CommonOptions& common, const std::stop_token& stop) {
  const auto rigor = requested_rigor(options);
  const bool structural = rigor == Rigor::structural;
  const bool analyze = options.analyze || rigor == Rigor::measure;
  check_options(options);
  const std::vector<Technique> disabled = disabled_techniques(options);
  const Engine engine = parse_engine(options.engine);
  if (engine == Engine::plain && (rigor == Rigor::pilot || structural))
    throw std::invalid_argument(fmt::format(
        "--rigor {} counts for the simd engine; with --engine plain give --rigor estimate", *options.rigor));
  if ((rigor == Rigor::pilot || structural) && is_in(disabled, Technique::box_tree))
    throw std::invalid_argument(fmt::format(
        "--rigor {} counts the tests of box trees, but box-tree may not be chosen; give --rigor estimate or "
        "measure",
        *options.rigor));
  if (options.map && rigor == Rigor::measure)
    throw std::invalid_argument("--rigor measure chooses for one workload; with --map give --analyze");
  if (options.map)
    return run_choose_map({options.workload, options.costs, rigor, disabled, engine, options.analyze, options.verbose,
                           options.checkpoint, options.resume},
                          common, stop);
  if (options.workload.lists.rows() > 1)
    throw std::invalid_argument("only with --map may --rays and --disc-radius have several values");
  options.workload.lists.choose_row(0);
  const int threads = sim::useful_threads(common.threads);
  const CostsInUse costs_in_use = options.costs.costs(common);
  note_doubt(costs_in_use, common);
  const CostTable& costs = costs_in_use.of(engine);
  validate::JobRequest request = options.workload.request(common);
  request.workload_only = !analyze;
  request.keep_scene = options.ranks.ranks.has_value();
  Result result;
  ChooseAnswer answer;
  answer.costs = costs;
  if (request.numbers_alone() && rigor == Rigor::pilot)
    throw std::invalid_argument("--rigor pilot needs rays: give a scene or files, or --rigor estimate");
  validate::Question question{.rigor = rigor, .threads = threads, .disabled = disabled, .stop = stop};
  if (rigor == Rigor::measure) question.rigor.reset();
  if (request.numbers_alone() && !rigor) question.rigor = Rigor::estimate;
  if (request.numbers_alone() && !analyze && !structural) {
    answer.workload = validate::workload_of_numbers(request);
    answer.effects = sim::effects_of_numbers(answer.workload);
    question.workload = answer.workload;
    result.stopped = decide(answer, question, costs);
    result.inputs = numbers_json(answer.workload);
    answer.title = describe_numbers(answer.workload);
    answer.whole = {.discs = answer.workload.samples, .rays = answer.workload.rays};
    if (options.ranks.ranks)
      answer.ranks = choose_ranks(options.ranks, answer.workload, 1, false, 0, answer.choice.best(),
                                  search_error(answer), making_time(answer.workload, request.seed, stop),
                                  costs[answer.choice.best().candidate.technique]);
  } else {
    const ProgressLine progress(common.quiet);
    const double share_of_job = analyze ? 0.3 : 1;  // a guess
    const validate::Job job = validate::make_job(request, stop, sim::part_of(progress.report(), 0, share_of_job));
    note_all(common, job);
    answer.workload = job.workload();
    answer.effects = job.observed().effects;
    const sim::Problem& problem = job.problem();
    question.problem = &problem;
    question.workload = job.workload();
    question.ray_count = job.given.rays;
    const bool by_pilot = question.rigor.value_or(validate::reachable_rigor(question, costs)) == Rigor::pilot;
    (by_pilot ? answer.shown_evidence_seconds : answer.evidence_seconds) = job.observed().seconds;
    result.stopped = decide(answer, question, costs);
    if (analyze && !result.stopped) {
      const CostTable priced = validate::costs_for(question, costs);
      const auto predict = [&](const Candidate& candidate) {
        return answer.by_sample() ? predicted_by_pilot(candidate, answer.choice, job, structural, priced, threads, stop)
                                  : predicted(candidate, job, false, priced, threads, stop);
      };
      const sim::Stopwatch analysing;
      answer.analysis = validate::analyse(problem, answer.choice.candidates,
                                          {.disabled = disabled,
                                           .engine = engine,
                                           .check_seconds = job.check_seconds,
                                           .threads = threads,
                                           .stop = stop,
                                           .predict = predict,
                                           .progress = sim::part_of(progress.report(), share_of_job, 1)});
      if (answer.analysis->stopped) result.stopped = measured(*answer.analysis);
      if (rigor == Rigor::measure && answer.analysis->best) {
        answer.rigor = Rigor::measure;
        answer.choosing_seconds += analysing.seconds();
        result.answers_at_limit = true;
      }
    }
    result.inputs = to_json(job, request);
    answer.title = describe(job);
    answer.whole = validate::whole_inputs(request, job, job.given.rays);
    if (options.ranks.ranks && !result.stopped) {
      const bool photon_paths = job.field == sim::Field::photons;
      const double photons =
          photon_paths ? static_cast<double>(job.photon_count) / static_cast<double>(job.rays.size()) : 1;
      answer.ranks = choose_ranks(options.ranks, answer.workload, photons, photon_paths,
                                  static_cast<double>(job.triangles), answer.choice.best(), search_error(answer),
                                  making_time(job, stop), costs[answer.choice.best().candidate.technique]);
    }
    answer.warnings = job.all_said();
    answer.ledgers = ledgers_json(job);
  }
  result.inputs["unit_costs"] = to_json(costs);
  result.inputs["rigor"] = name(answer.rigor);
  result.inputs["analyze"] = analyze;
  result.inputs["engine"] = name(engine);
  result.inputs["disabled"] = names_json(disabled);
  result.inputs["threads"] = threads;
  result.inputs["ranks"] = options.ranks.ranks ? Json(*options.ranks.ranks) : Json();
  answer.costs_origin = costs_in_use.origin;
  result.json = to_json(answer);
  result.text = to_text(answer, common.screen(), {.verbose = options.verbose, .measured = options.analyze});
  result.csv = to_csv(answer, result.inputs);
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
  add_count(*app, "--ranks", options->ranks.ranks,
            "also predict what so many processes (mpirun) take, each with --threads; default: not");
  add_number(*app, "--network", options->ranks.bytes_per_second,
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
  return {app, [options](const CommonOptions& common, const std::stop_token& stop) {
            return run_choose(*options, common, stop);
          }};
}

}  // namespace detp::cli
