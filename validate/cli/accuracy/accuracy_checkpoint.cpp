#include "accuracy_report.hpp"

#include "detp/validate/accuracy/accuracy_json.hpp"
#include "detp/validate/checkpoint/value_json.hpp"

namespace detp::validate {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(GrowingSeconds, fixed, per_ray, per_ray_squared)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SettingPilot, setting, scale, noise_squared_times_rays, bias_squared, mean_bias,
                                   rare_photons, seconds, settled)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EstimatorPilot, estimator, settings, runs, by_reference, noise_rays, rehearsed)
NLOHMANN_JSON_SERIALIZE_ENUM(ReferenceKind, {{ReferenceKind::known, "known"},
                                             {ReferenceKind::backward, "backward"},
                                             {ReferenceKind::both, "both"}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PilotJudge, kind, paths, photons, samples, error, seconds, missed_mean)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(AccuracyPilot, estimators, trace, photons_per_ray, casts_per_path, mean_square,
                                   judged_square, sample_distance, judge, rays, seconds, light)

}  // namespace detp::validate

namespace detp::cli {
namespace {

nlohmann::json or_null(const std::optional<double>& value) { return value ? nlohmann::json(*value) : nlohmann::json(); }

std::optional<double> number_of(const nlohmann::json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

SavedAccuracy accuracy_of(const nlohmann::json& json) {
  SavedAccuracy saved;
  if (const nlohmann::json& pilot = json.at("pilot"); !pilot.is_null())
    saved.pilot = pilot.get<validate::AccuracyPilot>();
  if (const nlohmann::json& check = json.at("check"); !check.is_null())
    saved.check = validate::AccuracyCheck{
        check.at("noise").get<double>(), check.at("seconds").get<double>(), check.at("trace_seconds").get<double>(),
        check.at("rays").get<double>(),  number_of(check.at("error")),      number_of(check.at("share_within"))};
  json.at("planning_seconds").get_to(saved.planning_seconds);
  for (const nlohmann::json& run : json.at("runs"))
    saved.runs.push_back({run.at("seed").get<std::uint64_t>(), run.at("seconds").get<double>(),
                          number_of(run.at("error")), run.at("irradiance").get<std::vector<double>>()});
  return saved;
}

}  // namespace

SavedAccuracy read_accuracy(const validate::CheckpointFile& file, const std::stop_token& stop) {
  const auto state = file.read(stop);
  if (!state) return {};
  try {
    return accuracy_of(*state);
  } catch (const nlohmann::json::exception& error) {
    throw file.damaged(error.what());
  }
}

void write_accuracy(validate::CheckpointFile& file, const SavedAccuracy& saved) {
  nlohmann::json state{{"pilot", nullptr}, {"check", nullptr}, {"planning_seconds", saved.planning_seconds}};
  if (saved.pilot) state["pilot"] = *saved.pilot;
  if (saved.check)
    state["check"] = {{"noise", saved.check->noise},
                      {"seconds", saved.check->seconds},
                      {"trace_seconds", saved.check->trace_seconds},
                      {"rays", saved.check->rays},
                      {"error", or_null(saved.check->error)},
                      {"share_within", or_null(saved.check->share_within)}};
  state["runs"] = nlohmann::json::array();
  for (const validate::MadeRerun& run : saved.runs)
    state["runs"].push_back(
        {{"seed", run.seed}, {"seconds", run.seconds}, {"error", or_null(run.error)}, {"irradiance", run.irradiance}});
  file.write(state);
}

}  // namespace detp::cli
