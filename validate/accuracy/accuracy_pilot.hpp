#pragma once

#include <cstdint>
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
  /// What the setting is: the radius; of nearest, k over the number of pieces of paths; 1 for triangle hits, which have no setting.
  double scale = 1;
  Estimate noise_squared_times_rays;  ///< noise² falls with the number of rays as 1/rays
  Estimate bias_squared;              ///< does not; may be below 0
  double seconds = 0;                 ///< of an estimate at all samples with the rays of one run of the pilot
};

struct EstimatorPilot {
  sim::Estimator estimator = sim::Estimator::disc;
  std::vector<SettingPilot> settings;  ///< of rising scale
  /// Of an estimate at all samples, besides tracing: the share of a setting's time that does not grow with the rays, and the rays of
  /// the setting's time.
  double fixed_share = 0;
  double rays_of_run = 1;
  std::size_t runs = 2;        ///< of each setting
  double surface_seconds = 0;  ///< for building what the estimator needs of the mesh

  /// noise² with so many rays, and bias²; both interpolated between the settings, linearly in logarithms (bias² that is not known to
  /// be above 0: linearly in the logarithm of the scale). Scales outside of the settings are those of the nearest one.
  [[nodiscard]] double noise_squared(double scale, double rays) const;
  /// Relative standard error of noise² when it is compared with the square error of one other run: of its mean in the pilot, and the
  /// spread of single runs.
  [[nodiscard]] double noise_squared_error(double scale) const;
  [[nodiscard]] Estimate bias_squared(double scale) const;
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

struct AccuracyPilot {
  std::vector<EstimatorPilot> estimators;
  double trace_fixed_seconds = 0;
  double trace_seconds_per_ray = 0;
  double photons_per_ray = 0;
  double mean_square = 0;       ///< B²
  double sample_distance = 0;   ///< mean edge of the mesh, scene units
  double reference_radius = 0;  ///< of the area-corrected estimates with which all are compared; 0: with a Reference
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
  std::vector<double> radii = {};          ///< of discs, rising; empty: from a quarter to twice the mean edge
  /// The irradiance to compare with, if it is known better than from the pilot itself. It must outlive the pilot.
  const Reference* reference = nullptr;
  double price = 2;  ///< pilots may together take so many times as long as the answer that they find, and always 1.5 s
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

/// Radii are h/4, h/2, h and 2h, h the mean edge of the triangles, unless others are given. Six runs of independent photons at up to 2000 of the scene's samples, weighted
/// by the area around each:
///
///     noise² = Σ w_i s_i²/B²           bias² = Σ w_i (y_i² - s²_{y,i}/6)/B² + β²        y: estimate - reference of the same run
///
/// The reference is the area-corrected estimate of radius h/2, or with few photons h: it loses no light at edges. β² is its own squared
/// bias, taken for a third of its squared difference from that of twice the radius: between that of a bias which grows as the
/// radius and one which grows as its square. No long run is needed, but a bias that all estimators share is not seen. With
/// AccuracyPilotOptions::reference, runs are at its samples, and bias² as in split_error. Standard errors by the jackknife over the
/// runs.
///
/// Throws std::invalid_argument for a scene without triangles or lights; NoLight; sim::Stopped on a stop request.
[[nodiscard]] AccuracyPilot make_accuracy_pilot(sim::Scene& scene, const AccuracyPilotOptions& options);

}  // namespace detp::validate
