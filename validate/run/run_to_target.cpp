#include "run_to_target.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/estimate/gather.hpp"
#include "detp/sim/technique/streamed.hpp"
#include "detp/validate/accuracy/accuracy_pilot.hpp"
#include "detp/validate/base/json.hpp"
#include "detp/validate/checkpoint/checkpoint_file.hpp"
#include "detp/validate/job/job.hpp"
#include "detp/validate/stopping/job_batches.hpp"
#include "detp/validate/stopping/shared_batches.hpp"

namespace detp::validate {
namespace {

constexpr double usual_first_rays = 1 << 16;

/// Photons were traced in a mesh, where estimates have a bias that a pilot can find.
bool has_bias(const Job& job) {
  return job.scene && !job.rays_from_file && job.field == sim::Field::photons && !job.scene->mesh.triangles.empty();
}

/// The band whose error ends the run; none: their sum, or there is only one.
BandInQuestion band_of(const RunTarget& target, const Job& job) {
  if (!target.band) {
    if (target.total && job.bands.size() > 1 && has_bias(job))
      throw std::invalid_argument(
          fmt::format("bias in a scene is found in one band: give --noise-of one of {}", fmt::join(job.bands, ", ")));
    return std::nullopt;
  }
  const auto named = std::ranges::find(job.bands, *target.band);
  if (job.bands.empty())
    throw std::invalid_argument("--noise-of names a band of powers, and there is one without a name");
  if (named == job.bands.end())
    throw std::invalid_argument(fmt::format("--noise-of: there is no band {}; there are {}, and all for their sum",
                                            detp::quoted(*target.band), fmt::join(job.bands, ", ")));
  return static_cast<std::size_t>(named - job.bands.begin());
}

/// The samples of discs in place of a scene's, as long as this lives.
class SamplesOfDiscs {
 public:
  SamplesOfDiscs(sim::Scene& scene, const std::vector<sim::Disc>& discs) : scene_(scene), overshoot_(scene.overshoot) {
    samples_.swap(scene_.samples);
    for (const sim::Disc& disc : discs) scene_.samples.push_back({disc.centre, disc.normal});
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
BiasEstimate bias_of(const Job& job, sim::Estimator estimator, double target, double most_rays, int threads,
                     const std::vector<double>& weights, BandInQuestion band, const std::stop_token& stop) {
  constexpr double enough = 0.25;
  const double radius = job.given.disc_radius;
  std::vector<double> relative;
  for (const sim::Disc& disc : job.discs) relative.push_back(disc.radius / radius);
  std::optional<sim::Scene> in_colour;
  if (job.scene->rgb) in_colour = sim::in_band(*job.scene, static_cast<int>(band.value()));
  sim::Scene& scene = in_colour ? *in_colour : *job.scene;
  const SamplesOfDiscs samples(scene, job.discs);
  PilotMaker pilots(scene, {.estimators = {estimator},
                            .radii = {radius / 4, radius / 2, radius},
                            .relative = relative,
                            .weights = weights,
                            .front_facing = job.front_facing,
                            .seed = job.seed + 1,
                            .threads = threads,
                            .stop = stop});
  BiasEstimate bias;
  AccuracyPilot pilot;
  const auto next = [&](const PilotSize& made) -> std::optional<PilotSize> {
    const EstimatorPilot& own = pilot.estimators.front();
    bias.squared = own.settings.back().bias_squared;
    bias.mean = own.settings.back().mean_bias;
    bias.runs = own.runs;
    bias.by = name(pilot.judge.kind);
    bias.seconds += pilot.seconds;
    bias.radius = 0;
    for (const SettingPilot& setting : own.settings)
      if (uses_radius(estimator) && setting.bias_squared.mean <= target * target) bias.radius = setting.scale;
    if (bias.interval().half_width() <= enough * target || 4 * made.rays > most_rays) return std::nullopt;
    return PilotSize{4 * made.rays, 4 * made.paths};
  };
  escalate(pilots, pilot, {usual_pilot_rays, pilots.first_paths()}, next);
  return bias;
}

/// Photons of a job's rays, divided among so many runs by their numbers; of more rays than `most` only some of the photons.
std::vector<sim::Paths> runs_of_photons(const Job& job, std::uint64_t runs, std::size_t most) {
  const std::uint64_t step = runs * (job.rays.size() / most + 1);
  const sim::PathRays rays = job.paths();
  std::vector<sim::Paths> all(runs);
  for (std::size_t i = 0; i < job.rays.size(); ++i) {
    const std::uint64_t photon = job.photons.empty() ? i : job.photons[i];
    if (photon % step >= runs) continue;
    all[photon % runs].add(rays, i, photon);
  }
  return all;
}

/// Bias of discs by half the radius with the same rays, where there is no scene to judge by; nothing if no ray meets a disc.
std::optional<BiasEstimate> bias_by_radii(const Job& job, const Candidate& candidate, int threads,
                                          const std::vector<double>& weights, BandInQuestion band,
                                          const std::stop_token& stop) {
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
      const sim::Outcome outcome = sim::run(problem, candidate, {.count = false, .stop = stop, .threads = threads});
      if (outcome.stopped) throw sim::Stopped("stopped during a pilot");
      found[narrow ? 1 : 0].push_back(irradiance_of(outcome, band));
    }
  const auto light = [](const std::vector<double>& run) {
    return std::ranges::any_of(run, [](double e) { return e > 0; });
  };
  if (std::ranges::none_of(found[0], light)) return std::nullopt;
  BiasEstimate bias;
  bias.squared = bias_by_two_radii(found[0], found[1], weights);
  bias.by = "half the radius with the same rays: blur common to both is not seen";
  bias.runs = runs;
  bias.seconds = watch.seconds();
  return bias;
}

/// All that decides what a run finds, but for its candidate: techniques find the same.
Json key_of(const RunRequest& request, const Job& job, double most_rays) {
  const RunTarget& target = *request.target;
  const bool nearest = request.estimator == sim::Estimator::nearest;
  return {{"seed", job.seed},
          {"estimator", name(request.estimator)},
          {"nearest", nearest ? describe(model::candidate_with(Technique::photon_map, request.parameters)) : "none"},
          {"engine", name(request.engine)},
          {"target", target.error.error},
          {"target of", target.total ? "noise and bias" : "noise"},
          {"confidence", target.error.confidence},
          {"limit of rays", most_rays},
          {"standard errors", request.standard_error},
          {"bands", fmt::format("{}", fmt::join(job.bands, ","))},
          {"noise of", target.band.value_or("all")},
          {"facing", job.front_facing ? "front" : "any"},
          {"materials", fmt::format("{}", fmt::join(target.faces.materials, ","))},
          {"groups", fmt::format("{}", fmt::join(target.faces.groups, ","))},
          {"digest of rays and discs", digest_of(job)}};
}

/// Throws sim::FileError for a file that is not a checkpoint of such a run; nothing if there is no file.
std::optional<SavedRun> read(const CheckpointFile& file, const std::stop_token& stop) {
  const auto state = file.read(stop);
  if (!state) return std::nullopt;
  try {
    return saved_run_of(*state);
  } catch (const nlohmann::json::exception& error) {
    throw file.damaged(error.what());
  } catch (const std::invalid_argument& error) {
    throw file.damaged(error.what());
  }
}

/// Weights of the job's discs, of which some may not count.
std::vector<double> weights_in_question(const Job& job, const sim::FaceNames& faces, const std::stop_token& stop) {
  if (faces.empty()) return weights_of(job);
  std::vector<double> weights = weights_of(job, Surfaces::all);
  if (!job.scene || job.scene->mesh.triangles.empty())
    throw std::invalid_argument("--material and --group name faces of a scene; there is none");
  std::vector<sim::Sample> samples;
  for (const sim::Disc& disc : job.discs) samples.push_back({disc.centre, disc.normal});
  keep_named(weights, job.scene->mesh, samples, faces, stop);
  return weights;
}

}  // namespace

double first_rays(double most_rays) { return std::min(usual_first_rays, most_rays); }

void run_to_target(RunAnswer& answer, const Job& job, const CandidateOfRun& candidate, const std::stop_token& stop,
                   const sim::ReportPhase& progress, sim::Ranks* ranks) {
  const sim::Stopwatch watch;
  const RunRequest& request = answer.request;
  const RunTarget& asked = *request.target;
  const int threads = request.job.threads;
  ErrorTarget target = asked.error;
  UntilAnswer until;
  const double limit =
      job.rays_from_file ? static_cast<double>(job.rays.size()) : request.job.rays.value_or(most_rays_by_default);
  std::optional<CheckpointFile> file;
  std::optional<SavedRun> saved;
  const RunCandidate chosen = agreed(ranks, [&]() -> RunCandidate {  // on rank 0
    if (asked.checkpoint) file.emplace(*asked.checkpoint, "run until an error", key_of(request, job, limit));
    if (asked.checkpoint && asked.resume) saved = read(*file, stop);
    if (!saved) return candidate.choose();
    if (const std::string missing = candidate.missing(saved->candidate); !missing.empty())
      throw sim::FileError(*asked.checkpoint, fmt::format("was made with {}, not {}; start again without it",
                                                          describe(saved->candidate), missing));
    return {saved->candidate, sim::thread_count(threads)};
  });
  answer.candidate = chosen.candidate;
  answer.threads = chosen.threads;
  const BandInQuestion band = band_of(asked, job);
  const auto search_here = [&] {
    sim::RunOptions search{.engine = request.engine, .stop = stop, .threads = answer.threads};
    search.standard_error = request.standard_error;
    return JobSearch(job, request.estimator, answer.candidate, search);
  };
  if (ranks != nullptr && ranks->rank() != 0) {
    JobSearch search = search_here();
    SharedBatches(job, search, stop, ranks, band).serve();
    return;
  }
  constexpr double most_pilot_rays = 4e6;
  const std::vector<double> weights = weights_in_question(job, asked.faces, stop);
  if (asked.faces.empty() && job.scene && std::ranges::find(weights, 0.0) != weights.end())
    until.mirror_share = mirror_share(job.scene->mesh);
  if (asked.total && has_bias(job))
    until.bias = bias_of(job, request.estimator, target.error, most_pilot_rays, threads, weights, band, stop);
  else if (asked.total && job.rays_from_file && request.estimator == sim::Estimator::disc)
    until.bias = bias_by_radii(job, answer.candidate, answer.threads, weights, band, stop);
  if (until.bias) target.bias_squared = until.bias->squared;
  JobSearch search = search_here();
  SharedBatches batches(job, search, stop, ranks, band);
  UntilOptions stages{.most_rays = limit,
                      .first_rays = static_cast<std::uint64_t>(first_rays(static_cast<double>(job.rays.size()))),
                      .most_in_batch = sim::default_block(job.discs.size()),
                      .progress = progress};
  ExecutedUntil before;
  if (saved) {
    batches.skip(saved->state.batch_count(), saved->state.batches.mean.photons, saved->state.rays);
    stages.resume = std::move(saved->state);
    before = std::move(saved->so_far);
  }
  SaveExecuted save;
  if (file)
    save = [&](const std::function<UntilState()>& state, const ExecutedUntil& so_far) {
      if (file->due() || stop.stop_requested()) file->write(json_of(answer.candidate, state(), so_far));
    };
  ExecutedUntil found =
      execute_until([&](std::uint64_t rays, std::uint64_t following) { return batches.next(rays, following); }, weights,
                    target, stages, std::move(before), save);
  if (found.result.reason == StopReason::time) batches.roll_call();
  found.fill_outcome(powers_add_up(job) ? found.result.photons : 1);
  sim::Outcome& outcome = answer.run.outcome = std::move(found.outcome);
  if (found.bands.empty())
    sim::resize_results(job.discs.size(), false, outcome, std::max<std::size_t>(1, job.bands.size()));
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

}  // namespace detp::validate
