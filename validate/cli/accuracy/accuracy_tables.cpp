#include "accuracy_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "detp/validate/cli/report/prediction_report.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/table.hpp"
#include "detp/validate/cli/text/words.hpp"

/// The answer as JSON and CSV.
namespace detp::cli {
namespace {

using validate::AccuracyPoint;

std::string_view kind_name(validate::AccuracyTarget::Kind kind) {
  using enum validate::AccuracyTarget::Kind;
  if (kind == seconds) return "seconds";
  return kind == noise ? "noise" : "error";
}

Json json_of(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json interval_json(const validate::AxisPoint& point) {
  return point.interval ? Json{point.interval->low, point.interval->high} : Json();
}

/// The point is what was run once.
bool is_checked(const AccuracyAnswer& answer, const AccuracyPoint& point) {
  const AccuracyPoint& run = answer.checked;
  return answer.check && point.estimator == run.estimator && point.rays == run.rays && point.radius == run.radius &&
         point.nearest == run.nearest;
}

Json point_json(const AccuracyAnswer& answer, const AccuracyPoint& point) {
  return {
      {"axis", "estimator"},
      {"estimator", name(point.estimator)},
      {"setting", setting_words(answer, point)},
      {"disc_radius", point.radius > 0 ? Json(point.radius) : Json()},
      {"nearest", point.nearest > 0 ? Json(point.nearest) : Json()},
      {"rays", gathers(point) ? 0 : std::round(point.rays)},
      {"paths", gathers(point) ? Json(std::round(point.rays)) : Json()},
      {"photons", std::round(point.photons)},
      {"command", command_of(answer, point)},
      {"noise", point.noise},
      {"noise_interval", {point.noise_low, point.noise_high}},
      {"noise_weak", point.noise_weak},
      {"bias", point.bias},
      {"bias_interval", {point.bias_low, point.bias_high}},
      {"mean_bias", point.mean_bias},
      {"mean_bias_error", point.mean_bias_error},
      {"error", point.total},
      {"error_interval", {point.total_low, point.total_high}},
      {"variance", point.noise * point.noise},
      {"slope", point.slope},
      {"slope_interval", {point.slope_low, point.slope_high}},
      {"predicted_seconds", point.seconds},
      {"measured_seconds", is_checked(answer, point) ? Json(answer.check->seconds) : Json()},
      {"processor_seconds", point.seconds * answer.threads},  // predicted, at most: all threads at work all the time
      {"on_frontier", point.on_frontier},
      {"cut_off", !gathers(point) && point.rays >= answer.most_rays}};
}

Json reference_json(const AccuracyAnswer& answer) {
  const validate::PilotJudge& judge = answer.pilot.judge;
  const bool photons = judge.kind == validate::ReferenceKind::both;
  return {{"kind", name(judge.kind)},   {"photons", photons ? Json(judge.photons) : Json()},
          {"paths", judge.paths},       {"samples", judge.samples},
          {"error", judge.error},       {"seconds", judge.seconds},
          {"missed", judge.missed_mean}};
}

/// Null without reruns.
Json reruns_json(const AccuracyAnswer& answer) {
  if (answer.reruns.empty()) return nullptr;
  Json runs = Json::array();
  for (const validate::AccuracyRerun& one : answer.reruns)
    runs.push_back({{"seed", one.seed}, {"noise", one.noise}, {"error", json_of(one.error)}, {"seconds", one.seconds}});
  return {{"inside_noise_interval", inside(answer)}, {"runs", runs}};
}

Json axis_json(const validate::AxisPoint& point) {
  return {
      {"axis", point.axis},           {"estimator", nullptr},
      {"setting", point.setting},     {"quantity", point.quantity},
      {"work", point.work},           {"command", nullptr},
      {"error", point.error},         {"error_interval", interval_json(point)},
      {"variance", nullptr},          {"bias", nullptr},
      {"predicted_seconds", nullptr}, {"measured_seconds", point.seconds},
      {"processor_seconds", nullptr}, {"merit", point.error > 0 && point.seconds > 0 ? Json(point.merit()) : Json()},
      {"on_frontier", nullptr},       {"cut_off", false}};
}

}  // namespace

std::string command_of(const AccuracyAnswer& answer, const AccuracyPoint& point) {
  std::string text = fmt::format("detp run {} --{} {:.3g} --estimator {}", shell_word(answer.scene),
                                 gathers(point) ? "paths" : "rays", point.rays, name(point.estimator));
  if (point.radius > 0) text += fmt::format(" --disc-radius {:.4g}", point.radius);
  if (point.nearest > 0) text += fmt::format(" --nearest {}", point.nearest);
  return text + answer.options;
}

Json to_json(const AccuracyAnswer& answer) {
  const AccuracyPoint& best = answer.plan.answer;
  Json chosen = point_json(answer, best);
  chosen.erase("axis");
  chosen.erase("on_frontier");
  chosen.erase("cut_off");
  chosen["technique"] = nullptr;
  if (sim::record_of(best.estimator).finds_pairs) chosen["technique"] = "box-tree";
  if (best.estimator == sim::Estimator::nearest) chosen["technique"] = "photon-map";
  chosen["reached"] = answer.plan.reached;
  chosen["trace_seconds"] = best.trace_seconds;
  chosen["predicted_seconds_interval"] = {best.seconds / seconds_factor, seconds_factor * best.seconds};
  if (answer.check) {
    chosen["measured_seconds"] = answer.check->seconds;
    chosen["measured_noise"] = answer.check->noise;
    chosen["measured_rays"] = answer.check->rays;
    chosen["checked"] = point_json(answer, answer.checked);
    chosen["measured_error"] = json_of(answer.check->error);
    chosen["within"] = within_of(answer.plan.target);
    chosen["share_within"] = json_of(answer.check->share_within);
  }
  chosen["text"] = answer_words(answer) + " " + command_of(answer, best);
  Json points = Json::array();
  for (const AccuracyPoint& point : answer.plan.points) points.push_back(point_json(answer, point));
  for (const validate::AxisPoint& point : answer.axes) points.push_back(axis_json(point));
  Json rivals = Json::array();
  for (const AccuracyPoint& point : answer.plan.rivals) {
    rivals.push_back(point_json(answer, point));
    rivals.back()["reached"] = reaches(point, answer.plan.target);
  }
  Json ties = Json::array();
  for (const sim::Estimator one : answer.plan.ties) ties.push_back(name(one));
  validate::WholeSeconds whole = validate::whole_seconds(answer.whole, {}, 0, 0);
  whole.trace = best.trace_seconds;
  whole.search = best.seconds - best.trace_seconds;
  return {{"answer", chosen},
          {"rivals", rivals},
          {"ties", ties},
          {"floor", answer.plan.floor},
          {"points", points},
          {"reference", reference_json(answer)},
          {"reruns", reruns_json(answer)},
          {"planning_seconds", answer.seconds},
          {"whole", whole_json(whole)},
          {"peak_bytes", validate::peak_bytes(answer.whole, 0)},
          {"pilot_rays", answer.pilot.rays},
          {"light", light_json(answer.pilot.light)},
          {"geometry", geometry_json(answer.polygons, answer.normals_made, answer.coincident)},
          {"warnings", answer.warnings}};
}

std::string csv_of(const AccuracyAnswer& answer) {
  Table table({"scene",
               "role",
               "target_kind",
               "target",
               "reached",
               "reference",
               "reference_error",
               "estimator",
               "setting",
               "quantity",
               "disc_radius",
               "nearest",
               "rays",
               "paths",
               "photons",
               "noise",
               "noise_low",
               "noise_high",
               "bias",
               "bias_low",
               "bias_high",
               "mean_bias",
               "error",
               "error_low",
               "error_high",
               "predicted_seconds",
               "on_frontier",
               "seed",
               "work",
               "measured_noise",
               "measured_error",
               "measured_seconds",
               "planning_seconds",
               "correction",
               "command"});
  const auto add_row = [&](const char* role, Json cells) {
    cells["scene"] = answer.scene;
    cells["role"] = role;
    cells["target_kind"] = kind_name(answer.plan.target.kind);
    cells["target"] = answer.plan.target.value;
    table.add(cells);
  };
  const auto add = [&](const char* role, const AccuracyPoint& point, const Json& measured = Json::object()) {
    Json cells = point_json(answer, point);
    cells["reached"] = reaches(point, answer.plan.target);
    cells["reference"] = name(answer.pilot.judge.kind);
    cells["reference_error"] = answer.pilot.judge.error;
    cells["bias_low"] = point.bias_low;
    cells["bias_high"] = point.bias_high;
    cells["noise_low"] = point.noise_low;
    cells["noise_high"] = point.noise_high;
    cells["error_low"] = point.total_low;
    cells["error_high"] = point.total_high;
    for (const char* other : {"axis", "noise_interval", "noise_weak", "bias_interval", "mean_bias_error",
                              "error_interval", "variance", "slope", "slope_interval", "processor_seconds", "cut_off"})
      cells.erase(other);
    cells.update(measured);
    add_row(role, cells);
  };
  const auto measured = [](double noise, const std::optional<double>& error, double seconds) {
    return Json{{"measured_noise", noise}, {"measured_error", json_of(error)}, {"measured_seconds", seconds}};
  };
  const auto& check = answer.check;
  Json checked = check ? measured(check->noise, check->error, check->seconds) : Json::object();
  checked["planning_seconds"] = answer.seconds;
  checked["correction"] = check ? Json(answer.plan.answer.rays / answer.checked.rays) : Json();
  add("answer", answer.plan.answer, checked);
  for (const AccuracyPoint& point : answer.plan.rivals) add("rival", point);
  for (const AccuracyPoint& point : answer.plan.points) add("point", point);
  for (const validate::AccuracyRerun& run : answer.reruns) {
    Json cells = measured(run.noise, run.error, run.seconds);
    cells["seed"] = run.seed;
    add_row("run", cells);
  }
  for (const validate::AxisPoint& point : answer.axes) {
    Json cells{{"setting", point.setting},
               {"quantity", point.quantity},
               {"error", point.error},
               {"measured_seconds", point.seconds},
               {"work", point.work}};
    if (point.interval) {
      cells["error_low"] = point.interval->low;
      cells["error_high"] = point.interval->high;
    }
    add_row(point.axis.c_str(), cells);
  }
  return table.csv();
}

}  // namespace detp::cli
