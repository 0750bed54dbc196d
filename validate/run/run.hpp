#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/estimate/estimate.hpp"
#include "detp/sim/estimate/face_sums.hpp"
#include "detp/sim/scene/selection.hpp"
#include "detp/validate/accuracy/error_split.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/choice/choice.hpp"
#include "detp/validate/job/job.hpp"
#include "detp/validate/picture/colour_scale.hpp"
#include "detp/validate/stopping/run_until.hpp"
#include "detp/validate/whole/whole.hpp"
#include "job_run.hpp"

/// The hits and the irradiance of a scene or of files by one technique: what `detp run` does, in one call.
namespace detp::validate {

/// An error at which a run ends.
struct RunTarget {
  ErrorTarget error = {};                      ///< without bias, which is found
  bool total = false;                          ///< of noise and bias together; else of the noise
  sim::FaceNames faces = {};                   ///< whose samples the error is of; none: all
  std::optional<std::string> band = {};        ///< of several: whose error it is; none: that of their sum
  std::optional<std::string> checkpoint = {};  ///< a file that keeps what is found
  bool resume = false;                         ///< from the checkpoint
};

struct RunRequest {
  JobRequest job = {};  ///< rays and discs, seed, threads, ranks; with a target, its rays are the limit (default: 1e9)
  sim::Estimator estimator = sim::Estimator::disc;
  std::optional<Technique> technique = {};  ///< default: the fastest, as chosen
  /// of the technique; what is not set is chosen. Without a technique: one that has all of these is chosen
  model::FixedParameters parameters = {};
  bool most_spheres = false;  ///< of a sphere cache: all that can hold a disc; else the best number
  Engine engine = Engine::simd;
  std::uint64_t paths = sim::paths_by_default;  ///< of gather: from each disc, on each side that counts
  std::optional<Form> form = {};            ///< of the technique's formulas that predict the counts; default: corrected
  CostTable costs = built_in_unit_costs();  ///< by which is chosen and predicted
  int repeat = 0;                           ///< further runs that are timed
  bool pairs = false;
  bool standard_error = false;
  bool keep_scene = false;               ///< files will have its triangles
  bool faces = false;                    ///< light on faces, by the landings of photons
  std::optional<RunTarget> target = {};  ///< the run ends when its error is below; default: all rays
  std::optional<sim::Share> share = {};  ///< what ranks share; default: usual_share

  [[nodiscard]] bool searches() const { return sim::record_of(estimator).finds_pairs; }
  [[nodiscard]] bool gathers() const { return sim::record_of(estimator).needs_scene; }
  /// The technique finds pairs, or the nearest photons.
  [[nodiscard]] bool has_technique() const { return searches() || estimator == sim::Estimator::nearest; }
  /// This process is the one that gets the answer.
  [[nodiscard]] bool answers() const { return job.ranks == nullptr || job.ranks->rank() == 0; }
};

/// Of an estimator at the radius of a run.
struct BiasEstimate {
  Estimate squared;    ///< relative to B²
  Estimate mean = {};  ///< signed, relative to the mean irradiance; not known by two radii
  std::size_t runs = 8;
  std::string by = {};  ///< what the estimator was compared with
  double seconds = 0;   ///< that finding it took
  double radius = 0;    ///< the largest of the radii tried whose bias is below the target; 0: none

  [[nodiscard]] RootInterval interval() const { return root_of(squared, runs); }
};

/// How a run until an error ended.
struct UntilAnswer {
  UntilResult result = {};
  std::optional<BiasEstimate> bias = {};
  double seconds = 0;           ///< with choosing, the bias's pilot, tracing and building
  sim::LightLedger light = {};  ///< of all photons that were traced
  double mirror_share = 0;      ///< of the area, that has no part in the error

  /// Noise and bias together; without a known bias the noise.
  [[nodiscard]] NoiseInterval error() const { return with_bias(result.noise, bias ? bias->squared : Estimate{}); }
};

/// Light on parts of the scene's surface.
struct LightOnParts {
  sim::SurfaceParts parts;
  sim::Outcome found;
};

struct LightOnFaces {
  sim::Outcome triangles;
  LightOnParts by_material;
  LightOnParts by_group;  ///< no parts if there are no groups
};

struct RunAnswer {
  RunRequest request = {};            ///< with the costs of the question
  Candidate candidate = {};           ///< of an estimator that uses none, without meaning
  int threads = 1;                    ///< on which it ran
  std::optional<Choice> choice = {};  ///< by which the candidate was chosen, with its rays in memory
  JobRun run = {};
  Timing timing = {};
  std::optional<UntilAnswer> until = {};
  std::optional<LightOnFaces> faces = {};
  std::optional<RaysTaken> taken = {};  ///< of a stream of photon paths: those that were searched
  WholeInputs whole = {};               ///< of the command, if the rays are known before

  /// The counts of the choice come from a pilot. Of brute force it knows all but the hits.
  [[nodiscard]] bool is_piloted() const {
    return request.estimator == sim::Estimator::disc && choice && choice->sampled_rays > 0;
  }
  /// A ray of a random field: the first rays are representative of all.
  [[nodiscard]] bool has_random_rays() const { return !request.job.ray_file; }
};

inline constexpr double most_rays_by_default = 1e9;  ///< of a run until an error

/// Throws std::invalid_argument for what excludes each other: an estimator with a technique that it does not use, a form that a technique does not have,
/// a target with pairs or repeated runs, or of an estimator that needs all rays at once.
void check(const RunRequest& request);

/// The request of the job that all of these need: they differ in how they search alone.
[[nodiscard]] JobRequest job_request(std::span<const RunRequest> requests);

/// Searches the job, which was made by job_request. Throws as validate::choose, sim::estimate and execute_until; std::length_error if the technique would
/// not fit in memory; sim::Stopped if a stop request came before there was anything, else the answer is partial. On ranks other than 0 the answer is empty.
[[nodiscard]] RunAnswer answer(const Job& job, const RunRequest& request, const std::stop_token& stop = {},
                               const sim::ReportPhase& progress = {});

struct JobAndRun {
  Job job;
  RunAnswer answer;
};

/// What `detp run` does: makes the job and searches it. Throws as `check`, make_job and the other one.
[[nodiscard]] JobAndRun answer(const RunRequest& request, const std::stop_token& stop = {},
                               const sim::ReportPhase& progress = {});

/// From where a picture shows the scene, and to where.
using SeenBetween = std::pair<glm::dvec3, glm::dvec3>;

/// A picture of the scene in the colours of its irradiance. Discs at all corners of a mesh colour its triangles; other discs the surface
/// around them (sim::NearestDisc); without a mesh they are drawn as they are.
struct Picture {
  static constexpr int usual_width = 800;
  std::string path;                      ///< .png or .svg
  std::optional<SeenBetween> view = {};  ///< default: sim::view_of_most
  Scaling scaling = Scaling::automatic;
  int width = usual_width;  ///< pixels of a view whose width is 4/3 of its height; others have as many in all
};

/// Files of what a run found. They appear complete or not at all.
struct RunFiles {
  std::optional<std::string> per_disc = {};  ///< place, hits and irradiance of each disc (sim::ResultFile)
  std::optional<std::string> per_face = {};  ///< the same of each triangle
  std::optional<std::string> pairs = {};     ///< "ray,disc" of each pair, as CSV
  std::optional<Picture> picture = {};       ///< the irradiance on the scene, and its standard error if that is known
};

struct WrittenRun {
  std::vector<std::string> notices = {};
  std::optional<SeenBetween> picture = {};
  std::optional<sim::Progress> stopped = {};  ///< if a stop request ended the run, the writing or the timed runs
};

/// Throws sim::FileError; std::invalid_argument for a picture of discs that are not in memory, or of a view that is none.
[[nodiscard]] WrittenRun write_files(const RunFiles& files, const Job& job, const RunAnswer& answer,
                                     const std::stop_token& stop = {});

/// The paper has formulas for the technique's counts.
[[nodiscard]] bool is_published(Technique technique);

/// Those of the paper's formulas if they are requested. Else the counts that a pilot predicted, or else the closed form on this workload: the job's, or what
/// is known of it without measuring. Nothing if the candidate has none, and of other estimators and runs until an error.
[[nodiscard]] std::optional<Counts<double>> prediction(const Workload& workload, const RunAnswer& answer);

/// What standard errors and further bands add to the seconds of a search with these counts.
[[nodiscard]] double seconds_of_sums(const Job& job, const RunAnswer& answer, const Counts<double>& counts);

/// Of the whole command: of pairs by the better of both forms, of estimators that look at photons by AccuracyCosts and the hits expected of closed forms.
/// Nothing for backward paths, whose rays are known only by a pilot (`accuracy`), and for runs until an error.
[[nodiscard]] std::optional<Whole> predicted_whole(const Job& job, const RunAnswer& answer, const Workload& workload);

/// The whole time so far was `seconds`; the memory is the peak of this process.
[[nodiscard]] Whole measured_whole(const Job& job, const RunAnswer& answer, double seconds);

/// What a run without hits met, and the likely reason; the light that is missing.
[[nodiscard]] std::vector<std::string> answer_warnings(const Job& job, const RunAnswer& answer);

/// Rays and photons; nothing if a run took the job's.
[[nodiscard]] std::optional<RaysTaken> taken_by(const Job& job, const RunAnswer& answer);

/// The estimated hits of all rays of a stopped run; nothing if no ray is finished, or if the finished rays do not represent all.
[[nodiscard]] std::optional<sim::SumEstimate> estimated_hits(const RunAnswer& answer);

/// What the first rays say of the mean irradiance by all, in each band; empty if they do not represent all rays.
[[nodiscard]] std::vector<sim::SumEstimate> estimated_irradiance(const Job& job, const RunAnswer& answer);

/// Mean over the discs, of each band.
[[nodiscard]] std::vector<double> mean_irradiance(const JobRun& run);

/// The counts, with the memory that belongs to them.
[[nodiscard]] Counts<std::uint64_t> counted(const RunAnswer& answer);

}  // namespace detp::validate
