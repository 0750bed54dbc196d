#include "run_until.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/technique/streamed.hpp"
#include "detp/validate/accuracy/accuracy_pilot.hpp"
#include "detp/validate/checkpoint/checkpoint_file.hpp"
#include "detp/validate/cli/options/number_option.hpp"
#include "detp/validate/job/job.hpp"
#include "detp/validate/stopping/job_batches.hpp"
#include "detp/validate/stopping/shared_batches.hpp"
#include "timed_run.hpp"

namespace detp::cli {
namespace {

constexpr double usual_first_rays = 1 << 16;

/// Photons were traced in a mesh, where estimates have a bias that a pilot can find.
bool has_bias(const validate::Job& job) {
  return job.scene && !job.rays_from_file && job.field == sim::Field::photons && !job.scene->mesh.triangles.empty();
}

/// The samples of a job's discs in place of its scene's, as long as this lives.
class SamplesOfDiscs {
 public:
  explicit SamplesOfDiscs(const validate::Job& job) : scene_(*job.scene), overshoot_(job.scene->overshoot) {
    samples_.swap(scene_.samples);
    for (const sim::Disc& disc : job.discs) scene_.samples.push_back({disc.centre, disc.normal});
  }
  ~SamplesOfDiscs() {
    samples_.swap(scene_.samples);
    scene_.overshoot = overshoot_;
  }
  SamplesOfDiscs(const SamplesOfDiscs&) = delete;
  SamplesOfDiscs& operator=(const SamplesOfDiscs&) = delete;

 private:
  sim::Scene& scene_;
  double overshoot_;
  std::vector<sim::Sample> samples_;
};

/// Bias of the estimator at the job's discs, from pilots that also try smaller radii. They are repeated with four times the rays and paths, up
/// to `most_rays`, until half the width of the bias's interval is at most a quarter of the target.
BiasEstimate bias_of(const validate::Job& job, sim::Estimator estimator, double target, double most_rays, int threads,
                     const std::vector<double>& weights, const std::stop_token& stop) {
  constexpr double enough = 0.25;
  const double radius = job.given.disc_radius;
  std::vector<double> relative;
  for (const sim::Disc& disc : job.discs) relative.push_back(disc.radius / radius);
  const SamplesOfDiscs samples(job);
  validate::PilotMaker pilots(*job.scene, {.estimators = {estimator},
                                           .radii = {radius / 4, radius / 2, radius},
                                           .relative = relative,
                                           .weights = weights,
                                           .front_facing = job.front_facing,
                                           .seed = job.seed + 1,
                                           .threads = threads,
                                           .stop = stop});
  BiasEstimate bias;
  validate::AccuracyPilot pilot;
  using Size = validate::PilotSize;
  const auto next = [&](const Size& made) -> std::optional<Size> {
    const validate::EstimatorPilot& own = pilot.estimators.front();
    bias.squared = own.settings.back().bias_squared;
    bias.mean = own.settings.back().mean_bias;
    bias.runs = own.runs;
    bias.by = name(pilot.judge.kind);
    bias.seconds += pilot.seconds;
    bias.radius = 0;
    for (const validate::SettingPilot& setting : own.settings)
      if (validate::uses_radius(estimator) && setting.bias_squared.mean <= target * target) bias.radius = setting.scale;
    if (bias.interval().half_width() <= enough * target || 4 * made.rays > most_rays) return std::nullopt;
    return Size{4 * made.rays, 4 * made.paths};
  };
  escalate(pilots, pilot, {validate::usual_pilot_rays, pilots.first_paths()}, next);
  return bias;
}

/// Photons of a job's rays, divided among so many runs by their numbers; of more rays than `most` only some of the photons.
std::vector<sim::Paths> runs_of_photons(const validate::Job& job, std::uint64_t runs, std::size_t most) {
  const std::uint64_t step = runs * (job.rays.size() / most + 1);
  std::vector<sim::Paths> all(runs);
  for (std::size_t i = 0; i < job.rays.size(); ++i) {
    const std::uint64_t photon = job.photons.empty() ? i : job.photons[i];
    if (photon % step >= runs) continue;
    sim::Paths& own = all[photon % runs];
    own.rays.push_back(job.rays[i]);
    own.photons.push_back(photon);
  }
  return all;
}

/// Bias of discs by half the radius with the same rays, where there is no scene to judge by; nothing if no ray meets a disc.
std::optional<BiasEstimate> bias_by_radii(const validate::Job& job, const Candidate& candidate, int threads,
                                          const std::vector<double>& weights, const std::stop_token& stop) {
  constexpr std::uint64_t runs = 8;
  constexpr std::size_t most_rays = 2'000'000;
  const sim::Stopwatch watch;
  std::vector<sim::Disc> half = job.discs;
  for (sim::Disc& disc : half) disc.radius /= 2;
  std::array<std::vector<std::vector<double>>, 2> found;
  for (const sim::Paths& paths : runs_of_photons(job, runs, most_rays))
    for (const bool narrow : {false, true}) {
      const sim::Problem problem =
          sim::make_problem(paths.rays, narrow ? half : job.discs, job.front_facing, threads, stop);
      sim::Outcome outcome = sim::run(problem, candidate, {.count = false, .stop = stop, .threads = threads});
      if (outcome.stopped) throw sim::Stopped("stopped during a pilot");
      found[narrow ? 1 : 0].push_back(std::move(outcome.irradiance));
    }
  const auto light = [](const std::vector<double>& run) {
    return std::ranges::any_of(run, [](double e) { return e > 0; });
  };
  if (std::ranges::none_of(found[0], light)) return std::nullopt;
  BiasEstimate bias;
  bias.squared = validate::bias_by_two_radii(found[0], found[1], weights);
  bias.by = "half the radius with the same rays: blur common to both is not seen";
  bias.runs = runs;
  bias.seconds = watch.seconds();
  return bias;
}

/// All that decides what a run finds, but for its candidate: techniques find the same.
Json key_of(const RunAnswer& answer, const validate::Job& job, const UntilAnswer& until, double most_rays,
            const sim::FaceNames& faces) {
  return {{"seed", job.seed},
          {"estimator", name(answer.estimator)},
          {"nearest", answer.estimator == sim::Estimator::nearest ? describe(answer.candidate) : "none"},
          {"engine", name(answer.engine)},
          {"target", until.target},
          {"target of", until.total ? "noise and bias" : "noise"},
          {"confidence", until.confidence},
          {"limit of rays", most_rays},
          {"standard errors", answer.standard_error},
          {"facing", job.front_facing ? "front" : "any"},
          {"materials", fmt::format("{}", fmt::join(faces.materials, ","))},
          {"groups", fmt::format("{}", fmt::join(faces.groups, ","))},
          {"digest of rays and discs", validate::digest_of(job)}};
}

/// Throws sim::FileError for a file that is not a checkpoint of such a run; nothing if there is no file.
std::optional<validate::SavedRun> read(const validate::CheckpointFile& file, const std::stop_token& stop) {
  const auto state = file.read(stop);
  if (!state) return std::nullopt;
  try {
    return validate::saved_run_of(*state);
  } catch (const nlohmann::json::exception& error) {
    throw file.damaged(error.what());
  } catch (const std::invalid_argument& error) {
    throw file.damaged(error.what());
  }
}

/// Weights of the job's discs, of which some may not count.
std::vector<double> weights_in_question(const validate::Job& job, const sim::FaceNames& faces,
                                        const std::stop_token& stop) {
  if (faces.empty()) return validate::weights_of(job);
  std::vector<double> weights = validate::weights_of(job, validate::Surfaces::all);
  if (!job.scene || job.scene->mesh.triangles.empty())
    throw std::invalid_argument("--material and --group name faces of a scene; there is none");
  std::vector<sim::Sample> samples;
  for (const sim::Disc& disc : job.discs) samples.push_back({disc.centre, disc.normal});
  validate::keep_named(weights, job.scene->mesh, samples, faces, stop);
  return weights;
}

std::string percent_words(double share) { return fmt::format("{:.2g} %", 100 * share); }

Json interval_json(const validate::NoiseInterval& interval) { return {known(interval.low), known(interval.high)}; }

}  // namespace

validate::ErrorTarget TargetOptions::target() const {
  if (noise && error) throw std::invalid_argument("give one of --target-noise and --target-error");
  validate::ErrorTarget target{.confidence = parse_share("--confidence", confidence)};
  target.error = noise ? parse_share("--target-noise", *noise) : parse_share("--target-error", *error);
  check(target);
  return target;
}

double first_rays(std::optional<double> most_rays) {
  return std::min(usual_first_rays, most_rays.value_or(usual_first_rays));
}

void run_to_target(RunAnswer& answer, const validate::Job& job, const TargetOptions& options, double most_rays,
                   const CandidateOfRun& candidate, int threads, const std::stop_token& stop,
                   const sim::ReportPhase& progress, sim::Ranks* ranks) {
  const sim::Stopwatch watch;
  validate::ErrorTarget target = options.target();
  UntilAnswer until{.target = target.error, .total = options.error.has_value(), .confidence = target.confidence};
  const double limit = job.rays_from_file ? static_cast<double>(job.rays.size()) : most_rays;
  std::optional<validate::CheckpointFile> file;
  std::optional<validate::SavedRun> saved;
  const Requested chosen = agreed(ranks, [&]() -> Requested {  // on rank 0
    if (options.checkpoint)
      file.emplace(*options.checkpoint, "run until an error", key_of(answer, job, until, limit, options.faces));
    if (options.checkpoint && options.resume) saved = read(*file, stop);
    if (!saved) return candidate.choose();
    if (const std::string missing = candidate.missing(saved->candidate); !missing.empty())
      throw sim::FileError(*options.checkpoint, fmt::format("was made with {}, not {}; start again without it",
                                                            describe(saved->candidate), missing));
    return {saved->candidate, sim::thread_count(threads)};
  });
  answer.candidate = chosen.candidate;
  answer.threads = chosen.threads;
  const auto search_here = [&] {
    sim::RunOptions search{.engine = answer.engine, .stop = stop, .threads = answer.threads};
    search.standard_error = answer.standard_error;
    return validate::JobSearch(job, answer.estimator, answer.candidate, search);
  };
  if (ranks != nullptr && ranks->rank() != 0) {
    validate::JobSearch search = search_here();
    validate::SharedBatches(job, search, stop, ranks).serve();
    return;
  }
  constexpr double most_pilot_rays = 4e6;
  const std::vector<double> weights = weights_in_question(job, options.faces, stop);
  if (options.faces.empty() && job.scene && std::ranges::find(weights, 0.0) != weights.end())
    until.mirror_share = validate::mirror_share(job.scene->mesh);
  if (until.total && has_bias(job))
    until.bias = bias_of(job, answer.estimator, target.error, most_pilot_rays, threads, weights, stop);
  else if (until.total && job.rays_from_file && answer.estimator == sim::Estimator::disc)
    until.bias = bias_by_radii(job, answer.candidate, answer.threads, weights, stop);
  if (until.bias) target.bias_squared = until.bias->squared;
  validate::JobSearch search = search_here();
  validate::SharedBatches batches(job, search, stop, ranks);
  validate::UntilOptions stages{
      .most_rays = limit,
      .first_rays = static_cast<std::uint64_t>(first_rays(static_cast<double>(job.rays.size()))),
      .most_in_batch = sim::default_block(job.discs.size()),
      .progress = progress};
  validate::ExecutedUntil before;
  if (saved) {
    batches.skip(saved->state.batch_count(), saved->state.batches.photons, saved->state.rays);
    stages.resume = std::move(saved->state);
    before = std::move(saved->so_far);
  }
  validate::SaveExecuted save;
  if (file)
    save = [&](const std::function<validate::UntilState()>& state, const validate::ExecutedUntil& so_far) {
      if (file->due() || stop.stop_requested()) file->write(validate::json_of(answer.candidate, state(), so_far));
    };
  validate::ExecutedUntil found = validate::execute_until(
      [&](std::uint64_t rays, std::uint64_t following) { return batches.next(rays, following); }, weights, target,
      stages, std::move(before), save);
  if (found.result.reason == validate::StopReason::time) batches.roll_call();
  sim::Outcome& outcome = answer.run.outcome = std::move(found.outcome);
  outcome.irradiance = std::move(found.result.irradiance);
  outcome.hits.resize(job.discs.size());  // none, if the run was stopped in its first batch
  for (const sim::PowerError& error : found.errors.of(outcome.irradiance, found.result.photons)) {
    outcome.standard_error.push_back(error.standard_error);
    outcome.upper_bound.push_back(error.upper_bound);
  }
  if (validate::powers_add_up(job))
    for (auto* values : {&outcome.irradiance, &outcome.standard_error, &outcome.upper_bound})
      for (double& value : *values) value *= found.result.photons;
  outcome.seconds.order += search.built().seconds.order;
  outcome.seconds.build += search.built().seconds.build;
  outcome.progress = {found.result.rays, std::max(found.result.rays, static_cast<std::uint64_t>(limit)), "rays"};
  answer.run.trace_seconds = found.make_seconds;
  answer.run.rays_in_memory = job.rays.size();
  answer.timing.phases = outcome.seconds;
  until.light = found.light;
  if (job.light) until.light += *job.light;
  until.result = std::move(found.result);
  until.seconds = watch.seconds() + job.trace_seconds;
  answer.until = std::move(until);
}

Json to_json(const UntilAnswer& until) {
  const validate::UntilResult& result = until.result;
  Json json{{"target", until.target},
            {"noise", known(result.noise.value)},
            {"noise_interval", interval_json(result.noise)},
            {"error", known(until.error().value)},
            {"error_interval", interval_json(until.error())},
            {"bias_estimate", nullptr},
            {"confidence", until.confidence},
            {"photons", result.photons},
            {"rays", result.rays},
            {"stop_tests", result.tests + result.looks},
            {"stopped_because", name(result.reason)},
            {"until_seconds", until.seconds}};
  if (result.share_bound) json["share_bound"] = *result.share_bound;
  if (until.mirror_share > 0) json["mirror_share"] = until.mirror_share;
  if (until.bias) {
    json["bias_estimate"] = std::sqrt(std::max(0.0, until.bias->squared.mean));
    json["bias_squared"] = {{"value", until.bias->squared.mean},
                            {"standard_error", until.bias->squared.standard_error}};
    const validate::RootInterval interval = until.bias->interval();
    json["bias_interval"] = {interval.low, interval.high};
    json["mean_bias"] = until.bias->mean.standard_error > 0 ? Json(until.bias->mean.mean) : Json();
    json["bias_by"] = until.bias->by;
    json["bias_seconds"] = until.bias->seconds;
    json["radius_for_target"] = until.bias->radius > 0 ? Json(until.bias->radius) : Json();
  }
  return json;
}

std::string until_text(const UntilAnswer& until, double side) {
  const validate::UntilResult& result = until.result;
  const std::string target = percent_words(until.target) + (until.total ? " error" : " noise");
  std::string text = "answer    ";
  if (result.share_bound)
    text += fmt::format("no photon met a disc: fewer than {:.2g} of {:.3g} photons do ({} confidence). ",
                        *result.share_bound * result.photons, result.photons, percent_words(until.confidence));
  else
    text +=
        fmt::format("{} noise, at most {} with {} confidence, after {:.3g} rays ({:.3g} photons) and {:.2g} s. ",
                    percent_words(result.noise.value), percent_words(result.noise.high),
                    percent_words(until.confidence), static_cast<double>(result.rays), result.photons, until.seconds);
  switch (result.reason) {
    case validate::StopReason::target:
      text += target + " is reached. ";
      break;
    case validate::StopReason::bias:
      text += target + " is not reached: the bias alone is as large, and more rays do not help. ";
      break;
    case validate::StopReason::rays:
      text += target + " is not reached: there are no more rays. ";
      break;
    case validate::StopReason::time:
      text += target + " was not reached when the run was stopped. ";
      break;
  }
  if (!until.bias) return text + "\n";
  const validate::RootInterval bias = until.bias->interval();
  text += fmt::format("The bias at this radius is {}, the total {} ({} to {}), by {}.",
                      bias.low > 0 ? fmt::format("{} ({} to {})", percent_words(bias.value), percent_words(bias.low),
                                                 percent_words(bias.high))
                                   : "at most " + percent_words(bias.high),
                      percent_words(until.error().value), percent_words(until.error().low),
                      percent_words(until.error().high), until.bias->by);
  if (until.bias->squared.mean > until.target * until.target)
    text +=
        until.bias->radius > 0
            ? fmt::format(" More rays do not lower it; {} needs a radius of at most {:.3g} ({:.2g} % of the scene).",
                          percent_words(until.target), until.bias->radius, 100 * until.bias->radius / side)
            : " More rays do not lower it, nor does a quarter of the radius: detp accuracy compares estimators.";
  return text + "\n";
}

}  // namespace detp::cli
