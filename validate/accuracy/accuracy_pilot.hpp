#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <vector>

#include "detp/sim/base/phase.hpp"
#include "detp/sim/photons/light_ledger.hpp"
#include "detp/sim/ranks/ranks.hpp"
#include "detp/validate/statistics/statistics.hpp"
#include "detp/validate/whole/accuracy_costs.hpp"
#include "reference.hpp"
#include "replicates.hpp"

/// Small runs that say how noise, bias and time of each estimator depend on its setting and on the number of rays.
namespace detp::validate {

/// One setting of an estimator.
struct SettingPilot {
  AccuracySetting setting;
  /// What the setting is: the radius; of nearest, k over the number of pieces of paths; 1 for those without a setting.
  double scale = 1;
  Estimate noise_squared_times_rays = {};  ///< noise² falls with the number of rays as 1/rays
  Estimate bias_squared = {};              ///< does not; may be below 0
  Estimate mean_bias = {};                 ///< signed, relative to the mean irradiance
  /// So many photons, if all brought the same, would bring the noise² of the pilot; of a rehearsal, 1 over its relative variance.
  double rare_photons = 1e9;
  GrowingSeconds seconds = {};  ///< of an estimate at all samples, without tracing
  bool settled = false;         ///< known well enough: a further pilot leaves it as it is
};

/// From so many rare photons on, the interval of noise holds; before it is weak.
inline constexpr double enough_rare_photons = 30;

struct EstimatorPilot {
  sim::Estimator estimator = sim::Estimator::disc;
  std::vector<SettingPilot> settings;  ///< of rising scale
  std::size_t runs = 2;                ///< of each setting
  double by_reference = 0;             ///< share of the judge in the variance of the settings' bias²
  double noise_rays = 0;               ///< of the runs that say how much noise there is
  double rehearsed = 0;                ///< scale of the setting whose noise is that of a rehearsal; 0: none

  /// noise² with so many rays, bias², and the mean bias; interpolated between the settings, linearly in logarithms (bias² that is not known to
  /// be above 0: linearly in the logarithm of the scale). Scales outside of the settings are those of the nearest one.
  [[nodiscard]] double noise_squared(double scale, double rays) const;
  /// Relative standard error of noise² when it is compared with the square error of one other run: of its mean in the pilot, and the
  /// spread of single runs.
  [[nodiscard]] double noise_squared_error(double scale) const;
  [[nodiscard]] Estimate bias_squared(double scale) const;
  [[nodiscard]] Estimate mean_bias(double scale) const;
  [[nodiscard]] double rare_photons(double scale) const;
  /// Of an estimate at all samples, without tracing.
  [[nodiscard]] GrowingSeconds seconds(double scale) const;
};

/// By what bias was judged.
struct PilotJudge {
  ReferenceKind kind = ReferenceKind::backward;
  std::uint64_t paths = 0;    ///< backward paths of each sample, on each side
  std::uint64_t photons = 0;  ///< for the light that these miss
  std::size_t samples = 0;
  double error = 0;  ///< Reference::error
  double seconds = 0;
  double missed_mean = 0;  ///< Reference::missed_mean
};

struct AccuracyPilot {
  std::vector<EstimatorPilot> estimators;
  GrowingSeconds trace = {};  ///< photon paths
  double photons_per_ray = 0;
  double casts_per_path = 0;   ///< rays that a backward path casts, with those of the other side
  double mean_square = 0;      ///< B²
  double judged_square = 0;    ///< the same at the judged samples alone
  double sample_distance = 0;  ///< mean edge of the mesh, scene units
  PilotJudge judge = {};
  double rays = 0;              ///< of all runs together
  double seconds = 0;           ///< that the pilot took
  sim::LightLedger light = {};  ///< of its photons

  /// What it found of an estimator that it has.
  [[nodiscard]] EstimatorPilot& of(sim::Estimator estimator);
  [[nodiscard]] const EstimatorPilot& of(sim::Estimator estimator) const;
};

inline constexpr double usual_pilot_rays = 40'000;
/// Of a pilot.
struct PilotSize {
  double rays = usual_pilot_rays;  ///< pieces of photon paths, of all runs together
  std::uint64_t paths = 0;         ///< backward paths of each sample, on each side, with those of the pilots before
};
/// Of the price of planning, for pilots; the rest is for rehearsals.
inline constexpr double share_of_pilots = 0.85;

struct AccuracyPilotOptions {
  std::vector<sim::Estimator> estimators;  ///< empty: all
  std::vector<double> radii = {};          ///< of discs, rising; empty: from a quarter to twice the mean edge
  std::vector<double> relative = {};       ///< radii of the scene's samples over those; none: 1
  std::vector<double> weights = {};        ///< of the scene's samples, with sum 1; none: by area
  const Reference* reference = nullptr;    ///< the judge, if it was made before; it must outlive the pilot
  double price = 0.3;        ///< pilots may together take so many times as long as the answer that they find
  double least_price = 0.5;  ///< seconds that they may always take
  bool front_facing = false;
  std::uint64_t seed = 1;
  int threads = 0;
  std::stop_token stop = {};
  sim::ReportPhase progress = {};
  sim::Ranks* ranks = nullptr;  ///< that have the same scene and reference, and share reruns; null: this process alone
};

/// The pilot's photons hardly meet the samples: no error is known. It says why that may be.
struct NoLight : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// Makes pilots in a scene, each with more rays or backward paths than the one before. The judge's paths add up.
class PilotMaker {
 public:
  /// The scene must outlive this. Throws std::invalid_argument for a scene without triangles or lights.
  PilotMaker(sim::Scene& scene, AccuracyPilotOptions options);
  ~PilotMaker();

  /// Radii are h/4, h/2, h and 2h, h the mean edge of the triangles, unless others are given. Eight runs of independent photons at up to
  /// 1000 of the scene's samples; errors and their intervals as in split_error, against backward paths (Reference), which share nothing
  /// with the estimators. The estimator `gather` is judged by the variance of these paths; its bias is the light that they miss. Settings that an earlier pilot `before` has settled are
  /// its own. Throws NoLight; sim::Stopped on a stop request.
  [[nodiscard]] AccuracyPilot make(const PilotSize& size, const AccuracyPilot* before = nullptr);
  /// Paths of each sample for a first pilot: 64 000 for all judged samples together.
  [[nodiscard]] std::uint64_t first_paths() const;
  /// Of a first pilot: fewer rays than usual_pilot_rays if these would take longer than options.least_price.
  [[nodiscard]] PilotSize first_size() const;
  /// Seconds of making what traces rays, and of what estimators need of the mesh, once for all pilots, by AccuracyCosts.
  [[nodiscard]] double fixed_seconds() const;
  /// Seconds of a pilot after `before`, by AccuracyCosts, without fixed_seconds.
  [[nodiscard]] double predicted_seconds(const PilotSize& size, const AccuracyPilot* before) const;

  struct RehearsalSize {
    double rays = 0;          ///< or backward paths at each sample
    std::size_t samples = 0;  ///< of those that have a weight
    double seconds = 0;       ///< by AccuracyCosts
  };
  /// With at most so many rays, and in so many seconds; nothing if that is too short to know more than the pilot, and of nearest, whose
  /// photons bring no sums of powers.
  [[nodiscard]] std::optional<RehearsalSize> rehearsal_size(const AccuracyPilot& pilot, const AccuracySetting& setting,
                                                            double most_rays, double seconds) const;
  /// Takes the noise of an estimator from more rays, and at more samples, than the pilot, in eight parts: the mean of what sim::finish says of
  /// each part, its error by their spread. `answer_rays`: for which the setting is rehearsed; variable-radius has radii as of so many. What the
  /// pilot said of the estimator's other settings changes in proportion; so does B². Throws as make.
  void rehearse(AccuracyPilot& pilot, const AccuracySetting& setting, const RehearsalSize& size, double answer_rays);

 private:
  class Runs;
  struct Part;
  /// Parts of a rehearsal, at the samples in these places.
  [[nodiscard]] std::vector<Part> parts_of(const AccuracySetting& setting, double rays,
                                           const std::vector<std::size_t>& places, double answer_rays);
  void report(const char* doing) const;
  /// The estimators in question with their settings, of runs of so many rays.
  [[nodiscard]] std::vector<EstimatorPilot> settings_of(double rays_of_run) const;
  /// Of a setting at all samples; `judged_hits_per_ray`: at those that are judged.
  [[nodiscard]] GrowingSeconds seconds_of(const SettingPilot& setting, double judged_hits_per_ray) const;

  sim::Scene& scene_;
  AccuracyPilotOptions options_;
  ReplicateMaker maker_;
  std::optional<ReferenceMaker> judge_;
  JudgedSamples judged_;
  AccuracyCosts costs_;
  double edge_;                   ///< mean, of the mesh
  std::uint64_t paths_made_ = 0;  ///< of the judge, at each sample
};

/// Makes pilots until what is asked for is known: `next` looks at `pilot`, may settle some of its settings, and says how large the next one
/// has to be; after nothing, no more is made. Throws as PilotMaker::make: `pilot` is then the one before.
void escalate(PilotMaker& maker, AccuracyPilot& pilot, PilotSize size,
              const std::function<std::optional<PilotSize>(const PilotSize& made)>& next);

}  // namespace detp::validate
