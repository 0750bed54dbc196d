#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <stop_token>
#include <vector>

#include "detp/sim/base/phase.hpp"
#include "detp/sim/photons/light_ledger.hpp"
#include "detp/sim/ranks/ranks.hpp"
#include "detp/validate/statistics/statistics.hpp"
#include "reference.hpp"
#include "replicates.hpp"

/// Small runs that say how noise, bias and time of each estimator depend on its setting and on the number of rays.
namespace detp::validate {

/// One setting of an estimator.
struct SettingPilot {
  AccuracySetting setting;
  /// What the setting is: the radius; of nearest, k over the number of pieces of paths; 1 for those without a setting.
  double scale = 1;
  Estimate noise_squared_times_rays;  ///< noise² falls with the number of rays as 1/rays
  Estimate bias_squared;              ///< does not; may be below 0
  Estimate mean_bias;                 ///< signed, relative to the mean irradiance
  double seconds = 0;                 ///< of an estimate at all samples with the rays of one run of the pilot
  bool settled = false;               ///< known well enough: a further pilot leaves it as it is
};

struct EstimatorPilot {
  sim::Estimator estimator = sim::Estimator::disc;
  std::vector<SettingPilot> settings;  ///< of rising scale
  /// Of an estimate at all samples, besides tracing: the share of a setting's time that does not grow with the rays, and the rays of
  /// the setting's time.
  double fixed_share = 0;
  double rays_of_run = 1;
  std::size_t runs = 2;        ///< of each setting
  double by_reference = 0;     ///< share of the judge in the variance of the settings' bias²
  double surface_seconds = 0;  ///< for building what the estimator needs of the mesh

  /// noise² with so many rays, bias², and the mean bias; interpolated between the settings, linearly in logarithms (bias² that is not known to
  /// be above 0: linearly in the logarithm of the scale). Scales outside of the settings are those of the nearest one.
  [[nodiscard]] double noise_squared(double scale, double rays) const;
  /// Relative standard error of noise² when it is compared with the square error of one other run: of its mean in the pilot, and the
  /// spread of single runs.
  [[nodiscard]] double noise_squared_error(double scale) const;
  [[nodiscard]] Estimate bias_squared(double scale) const;
  [[nodiscard]] Estimate mean_bias(double scale) const;
  /// Of an estimate with so many rays, at all samples, without tracing: seconds_fixed + rays · seconds_per_ray.
  [[nodiscard]] double fixed_seconds(double scale) const {
    return surface_seconds + fixed_share * seconds_of_run(scale);
  }
  [[nodiscard]] double seconds_per_ray(double scale) const {
    return (1 - fixed_share) * seconds_of_run(scale) / rays_of_run;
  }

 private:
  [[nodiscard]] double seconds_of_run(double scale) const;
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
  double trace_fixed_seconds = 0;
  double trace_seconds_per_ray = 0;
  double photons_per_ray = 0;
  double mean_square = 0;      ///< B²
  double sample_distance = 0;  ///< mean edge of the mesh, scene units
  PilotJudge judge = {};
  double rays = 0;              ///< of all runs together
  double seconds = 0;           ///< that the pilot took
  sim::LightLedger light = {};  ///< of its photons

  [[nodiscard]] double trace_seconds(double rays_of_run) const {
    return trace_fixed_seconds + trace_seconds_per_ray * rays_of_run;
  }
};

inline constexpr double usual_pilot_rays = 40'000;

struct AccuracyPilotOptions {
  std::vector<sim::Estimator> estimators;  ///< empty: all
  double rays = 0;                         ///< of all runs of the pilot together; 0: usual_pilot_rays
  std::uint64_t paths = 0;         ///< of the judge, for each sample, on each side; 0: 64000 for all samples together
  std::vector<double> radii = {};  ///< of discs, rising; empty: from a quarter to twice the mean edge
  std::span<const double> relative = {};  ///< radii of the scene's samples over those; none: 1
  std::span<const double> weights = {};   ///< of the scene's samples, with sum 1; none: by area
  const Reference* reference = nullptr;   ///< the judge, if it was made before; it must outlive the pilot
  double price = 2;          ///< pilots may together take so many times as long as the answer that they find
  double least_price = 1.5;  ///< seconds that they may always take
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
  [[nodiscard]] AccuracyPilot make(double rays, std::uint64_t paths, const AccuracyPilot* before = nullptr);
  /// Paths of each sample for a first pilot.
  [[nodiscard]] std::uint64_t first_paths() const;

 private:
  class Runs;
  sim::Scene& scene_;
  AccuracyPilotOptions options_;
  ReplicateMaker maker_;
  std::optional<ReferenceMaker> judge_;
  JudgedSamples judged_;
};

/// One pilot, with the options' rays and paths.
[[nodiscard]] AccuracyPilot make_accuracy_pilot(sim::Scene& scene, const AccuracyPilotOptions& options);

}  // namespace detp::validate
