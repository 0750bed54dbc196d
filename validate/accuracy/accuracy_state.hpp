#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "accuracy_check.hpp"
#include "detp/validate/checkpoint/value_json.hpp"

/// What the search for an answer has found so far, as JSON for checkpoints and ranks.
namespace detp::validate {

NLOHMANN_JSON_SERIALIZE_ENUM(ReferenceKind, {{ReferenceKind::known, "known"},
                                             {ReferenceKind::backward, "backward"},
                                             {ReferenceKind::both, "both"}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(AccuracySetting, estimator, radius, nearest)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(GrowingSeconds, fixed, per_ray, per_ray_squared)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SettingPilot, setting, scale, noise_squared_times_rays, bias_squared, mean_bias,
                                   rare_photons, seconds, settled)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EstimatorPilot, estimator, settings, runs, by_reference, noise_rays, rehearsed)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PilotJudge, kind, paths, photons, samples, error, seconds, missed_mean)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(AccuracyPilot, estimators, trace, photons_per_ray, casts_per_path, mean_square,
                                   judged_square, sample_distance, judge, rays, seconds, light)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(AccuracyCheck, noise, seconds, trace_seconds, rays, error, share_within)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(AccuracyRerun, seed, seconds, error, irradiance)

/// Of a pilot that was complete, and before the check changed it.
struct SavedAccuracy {
  std::optional<AccuracyPilot> pilot = {};
  std::optional<AccuracyCheck> check = {};  ///< without its point, which is the plan's answer
  double planning_seconds = 0;              ///< of pilots and check
  std::vector<AccuracyRerun> runs = {};
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SavedAccuracy, pilot, check, planning_seconds, runs)

}  // namespace detp::validate
