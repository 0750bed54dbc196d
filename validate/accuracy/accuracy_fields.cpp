#include <fmt/format.h>

#include <cmath>

#include "accuracy_answer.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/validate/answer/parts.hpp"

/// The fields of the answer, each listed once.
namespace detp::validate {
namespace {

/// A row of the table, of which one of the last three is set; also a point in JSON.
struct AccuracyRow {
  const AccuracyAnswer* answer;
  std::string role;  ///< "answer", "rival", "point", "run", or the name of another axis
  const AccuracyPoint* point = nullptr;
  const AccuracyRerun* run = nullptr;
  const AxisPoint* axis = nullptr;

  /// The run of the answer to check it.
  [[nodiscard]] const AccuracyCheck* check() const {
    return role == "answer" && answer->check ? &*answer->check : nullptr;
  }
  [[nodiscard]] Json reached() const { return point ? Json(reaches(*point, answer->plan.target)) : left_out(); }
  [[nodiscard]] Json judged_by() const { return point ? Json(name(answer->pilot.judge.kind)) : left_out(); }
  [[nodiscard]] Json judge_error() const { return point ? Json(answer->pilot.judge.error) : left_out(); }
  [[nodiscard]] std::string axis_name() const { return axis ? axis->axis : "estimator"; }
  [[nodiscard]] Json setting() const {
    return point ? Json(setting_words(*answer, *point)) : value_at(axis, &AxisPoint::setting);
  }
  [[nodiscard]] Json error() const { return point ? Json(point->total.value) : value_at(axis, &AxisPoint::error); }
  [[nodiscard]] Json error_interval() const {
    if (point) return Json{point->total.low, point->total.high};
    return axis && axis->interval ? Json{axis->interval->low, axis->interval->high} : Json();
  }
  [[nodiscard]] Json processor_seconds() const {
    return point ? Json(point->seconds * sim::useful_threads(answer->request.threads)) : Json();
  }
  [[nodiscard]] bool cut_off() const { return point && !point->gathers() && point->rays >= answer->request.most_rays; }
  [[nodiscard]] Json measured_noise() const {
    return run ? Json(run->noise) : value_at(check(), &AccuracyCheck::noise);
  }
  [[nodiscard]] Json measured_error() const {
    return run ? json_value(run->error) : value_at(check(), &AccuracyCheck::error);
  }
  /// Of the answer, and of a point that is what was run to check.
  [[nodiscard]] std::optional<double> measured_seconds() const {
    if (!point) return run ? run->seconds : axis->seconds;
    if (!answer->check) return std::nullopt;
    const AccuracyPoint& checked = answer->check->point;
    const bool same = point->estimator == checked.estimator && point->rays == checked.rays &&
                      point->radius == checked.radius && point->nearest == checked.nearest;
    return same || check() ? std::optional(answer->check->seconds) : std::nullopt;
  }
  [[nodiscard]] Json planning_seconds() const { return role == "answer" ? Json(answer->planning_seconds) : left_out(); }
  [[nodiscard]] Json correction() const {
    return check() ? Json(answer->plan.answer.rays / check()->point.rays) : left_out();
  }
  [[nodiscard]] Json command() const { return point ? Json(command_of(*answer, *point)) : Json(); }
};

constexpr auto name_in_json = [](auto one) { return name(one); };
constexpr auto interval_in_json = [](const RootInterval& root) { return Json{root.low, root.high}; };
constexpr auto null_if_unused = [](auto number) { return number > 0 ? Json(number) : Json(); };

/// What points of other axes have as null.
template <class... Members>
auto point_or_null(Members... members) {
  return [members...](const AccuracyRow& row) { return row.point ? value_at(*row.point, members...) : Json(); };
}

const Fields<AccuracyRow>& accuracy_row_fields() {
  using enum FieldPlace;
  using Answer = AccuracyAnswer;
  using Point = AccuracyPoint;
  using Row = AccuracyRow;
  using Root = RootInterval;
  using One = Field<Row>;
  const auto of_target = [](const auto& part) { return at(&Row::answer, &Answer::plan, &AccuracyPlan::target, part); };
  const auto of_point = [](const auto&... parts) { return at(&Row::point, parts...); };
  const auto rays = [](const Point& point) { return point.gathers() ? 0 : std::round(point.rays); };
  const auto paths = [](const Point& point) { return point.gathers() ? Json(std::round(point.rays)) : Json(); };
  const auto photons = [](const Point& point) { return std::round(point.photons); };
  const auto variance = [](const Point& point) { return point.noise.value * point.noise.value; };
  const auto merit = [](const AxisPoint& one) { return one.error > 0 && one.seconds > 0 ? Json(one.merit()) : Json(); };
  static const Fields<Row> fields{
      {"scene", "", "as it was named",
       at(&Row::answer, &Answer::request, &AccuracyRequest::scene, &sim::SceneRequest::name), tables_alone},
      {"role", "", "answer, rival, point, run, or another axis", &Row::role, tables_alone},
      {"target_kind", "", "noise, error or seconds",
       at(&Row::answer, &Answer::plan, &AccuracyPlan::target, &AccuracyTarget::kind, name_in_json), tables_alone},
      {"target", "", "the error to reach, or the seconds that a run may take", of_target(&AccuracyTarget::value),
       tables_alone},
      {"reached", "", "the point has the target's error", &Row::reached, tables_alone},
      {"reference", "", "what bias was judged by", &Row::judged_by, tables_alone},
      {"reference_error", "", "its standard error, relative to the root mean square irradiance", &Row::judge_error,
       tables_alone},
      {"axis", "", "where accuracy costs time: estimator, simulation, model or arithmetic", &Row::axis_name,
       json_alone},
      {"estimator", "", "the estimator", point_or_null(&Point::estimator, name_in_json)},
      {"setting", "", "the radius as a share of the scene's side, or k; of other axes the way", &Row::setting},
      {"quantity", "", "of other axes: what the error is of", at(&Row::axis, &AxisPoint::quantity)},
      {"disc_radius", "", "in units of the scene; null: not used", of_point(&Point::radius, null_if_unused)},
      {"nearest", "", "k of the estimator nearest; null: not used", of_point(&Point::nearest, null_if_unused)},
      {"rays", "", "pieces of photon paths", of_point(rays)},
      {"paths", "", "backward paths of each sample, of gather", of_point(paths)},
      {"photons", "", "predicted", of_point(photons)},
      {"noise", "", "of one run, relative to the root mean square irradiance", of_point(&Point::noise, &Root::value)},
      One("noise_interval", "", "95 %", of_point(&Point::noise, interval_in_json)).as_interval("noise"),
      {"noise_weak", "", "few photons bring most of the noise: its interval may not hold", of_point(&Point::noise_weak),
       json_alone},
      {"bias", "", "relative to the root mean square irradiance", point_or_null(&Point::bias, &Root::value)},
      One("bias_interval", "", "95 %; from 0: there may be none", of_point(&Point::bias, interval_in_json))
          .as_interval("bias"),
      {"mean_bias", "", "light gained (> 0) or lost, relative to the mean irradiance",
       of_point(&Point::mean_bias, &Estimate::mean)},
      {"mean_bias_error", "", "its standard error", of_point(&Point::mean_bias, &Estimate::standard_error), json_alone},
      {"error", "", "noise and bias together; of other axes the relative error", &Row::error},
      One("error_interval", "", "95 %", &Row::error_interval).as_interval("error"),
      {"variance", "", "the square of noise", point_or_null(variance), json_alone},
      {"slope", "", "the error changes as this power of the seconds", of_point(&Point::slope, &Root::value),
       json_alone},
      {"slope_interval", "", "that of the error", of_point(&Point::slope, interval_in_json), json_alone},
      {"predicted_seconds", "s", "of a run, tracing included", point_or_null(&Point::seconds)},
      {"processor_seconds", "s", "predicted, at most: all threads at work all the time", &Row::processor_seconds,
       json_alone},
      {"on_frontier", "", "no other point is more accurate and faster, their intervals apart",
       point_or_null(&Point::on_frontier)},
      {"cut_off", "", "the point needs all rays that there may be", &Row::cut_off, json_alone},
      {"seed", "", "of a run again", at(&Row::run, &AccuracyRerun::seed), tables_alone},
      {"work", "", "of other axes: lines, pairs or rays", at(&Row::axis, &AxisPoint::work)},
      {"merit", "1/s", "of other axes: 1/(error² seconds)", at(&Row::axis, merit), json_alone},
      {"measured_noise", "", "of the run to check, or of a run again", &Row::measured_noise},
      {"measured_error", "", "its error against the reference; null without one", &Row::measured_error},
      {"measured_seconds", "s", "of the run to check, of a run again, or of another axis", &Row::measured_seconds},
      {"planning_seconds", "s", "that the pilots and the check took", &Row::planning_seconds, tables_alone},
      {"correction", "", "rays of the answer over those of the run to check", &Row::correction, tables_alone},
      {"command", "", "that runs the point", &Row::command}};
  return fields;
}

Json accuracy_point_json(const AccuracyAnswer& answer, const AccuracyPoint& point, const char* role) {
  return json_of(accuracy_row_fields(), {.answer = &answer, .role = role, .point = &point});
}

template <class List, class Make>
Json accuracy_array(const List& list, const Make& make) {
  Json all = Json::array();
  for (const auto& one : list) all.push_back(make(one));
  return all;
}

/// What the answer has more than another point.
const Fields<AccuracyAnswer>& chosen_point_fields() {
  using Answer = AccuracyAnswer;
  const auto technique = [](const Answer& answer) {
    const sim::Estimator estimator = answer.plan.answer.estimator;
    if (estimator == sim::Estimator::nearest) return Json("photon-map");
    return sim::record_of(estimator).finds_pairs ? Json("box-tree") : Json();
  };
  const auto seconds = [](const Answer& answer) {
    return Json{answer.plan.answer.seconds / seconds_factor, seconds_factor * answer.plan.answer.seconds};
  };
  const auto checked = [](const Answer& answer) {
    return answer.check ? accuracy_point_json(answer, answer.check->point, "point") : left_out();
  };
  const auto within = [](const Answer& answer) { return answer.check ? Json(answer.within()) : left_out(); };
  const auto text = [](const Answer& answer) {
    return answer_words(answer) + " " + command_of(answer, answer.plan.answer);
  };
  static const Fields<Answer> fields{
      {"technique", "", "how a run finds pairs, or photons; null: by none", technique},
      {"reached", "", "an estimator reaches the target", at(&Answer::plan, &AccuracyPlan::reached)},
      {"trace_seconds", "s", "of predicted_seconds, for tracing photons",
       at(&Answer::plan, &AccuracyPlan::answer, &AccuracyPoint::trace_seconds)},
      {"predicted_seconds_interval", "s", "in which the seconds of a run mostly lie", seconds},
      {"measured_rays", "", "of the run to check", at(&Answer::check, &AccuracyCheck::rays)},
      {"checked", "", "the point that was run to check", checked},
      {"within", "", "the error of share_within", within},
      {"share_within", "", "share of the reference's samples with at most this error; null without one",
       at(&Answer::check, &AccuracyCheck::share_within)},
      {"text", "", "the answer in sentences, with its command", text}};
  return fields;
}

const Fields<PilotJudge>& pilot_judge_fields() {
  using Judge = PilotJudge;
  const auto photons = [](const Judge& judge) {
    return judge.kind == ReferenceKind::both ? Json(judge.photons) : Json();
  };
  static const Fields<Judge> fields{
      {"kind", "", "known, backward paths, or backward paths and photons", at(&Judge::kind, name_in_json)},
      {"photons", "", "for the light that backward paths miss", photons},
      {"paths", "", "backward paths of each sample, on each side", &Judge::paths},
      {"samples", "", "at which bias is judged", &Judge::samples},
      {"error", "", "standard error, relative to the root mean square irradiance", &Judge::error},
      {"seconds", "s", "that making it took", &Judge::seconds},
      {"missed", "", "share of the light that backward paths miss", &Judge::missed_mean}};
  return fields;
}

const Fields<AccuracyRerun>& accuracy_rerun_fields() {
  static const Fields<AccuracyRerun> fields{
      {"seed", "", "of the run", &AccuracyRerun::seed},
      {"noise", "", "difference from the mean of all runs", &AccuracyRerun::noise},
      {"error", "", "against the reference; null without one", &AccuracyRerun::error},
      {"seconds", "s", "that it took", &AccuracyRerun::seconds}};
  return fields;
}

const Fields<AccuracyAnswer>& accuracy_answer_fields() {
  using Answer = AccuracyAnswer;
  const auto chosen = [](const Answer& answer) {
    Json json = accuracy_point_json(answer, answer.plan.answer, "answer");
    for (const char* of_curves : {"axis", "on_frontier", "cut_off"}) json.erase(of_curves);
    json.update(json_of(chosen_point_fields(), answer));
    return json;
  };
  const auto rivals = [](const Answer& answer) {
    return accuracy_array(answer.plan.rivals, [&](const AccuracyPoint& point) {
      Json rival = accuracy_point_json(answer, point, "rival");
      rival["reached"] = reaches(point, answer.plan.target);
      return rival;
    });
  };
  const auto points = [](const Answer& answer) {
    Json all = accuracy_array(answer.plan.points,
                              [&](const AccuracyPoint& point) { return accuracy_point_json(answer, point, "point"); });
    for (const AxisPoint& point : answer.axes)
      all.push_back(json_of(accuracy_row_fields(), {.answer = &answer, .role = point.axis, .axis = &point}));
    return all;
  };
  const auto reruns = [](const Answer& answer) {
    if (answer.reruns.empty()) return Json();
    const auto run = [](const AccuracyRerun& one) { return json_of(accuracy_rerun_fields(), one); };
    return Json{{"inside_noise_interval", answer.inside()}, {"runs", accuracy_array(answer.reruns, run)}};
  };
  const auto names = [](const std::vector<sim::Estimator>& all) { return accuracy_array(all, name_in_json); };
  const auto judge = [](const PilotJudge& one) { return json_of(pilot_judge_fields(), one); };
  const auto geometry = [](const Answer& answer) {
    return geometry_json(answer.polygons, answer.normals_made, answer.coincident);
  };
  static const Fields<Answer> fields{
      {"answer", "", "the fastest way to the target; if none reaches it, the most accurate one", chosen},
      {"rivals", "", "the best way of each other estimator, and whether it reaches the target", rivals},
      {"ties", "", "rivals that seconds do not tell from the answer", at(&Answer::plan, &AccuracyPlan::ties, names)},
      {"floor", "", "least bias of any estimator", at(&Answer::plan, &AccuracyPlan::floor)},
      {"points", "", "error against time: of each estimator from few to many rays, and of other axes", points},
      {"reference", "", "what bias was judged by", at(&Answer::pilot, &AccuracyPilot::judge, judge)},
      {"reruns", "", "the runs again, and how many have a noise in the answer's interval", reruns},
      {"planning_seconds", "s", "that the pilots and the check took", &Answer::planning_seconds},
      {"whole", "s", "the whole wait of a run of the answer, predicted", at(&Answer::whole, whole_json)},
      {"peak_bytes", "bytes", "its memory, predicted", &Answer::peak_bytes},
      {"pilot_rays", "", "pieces of photon paths of the last pilot", at(&Answer::pilot, &AccuracyPilot::rays)},
      {"light", "", "where the light of the pilot's photons went",
       at(&Answer::pilot, &AccuracyPilot::light, light_json)},
      {"geometry", "", "what was found in the mesh", geometry},
      {"warnings", "", "notices and warnings", &Answer::warnings}};
  return fields;
}

const Fields<AccuracyAnswer>& accuracy_input_fields() {
  using Answer = AccuracyAnswer;
  using Request = AccuracyRequest;
  using Kind = AccuracyTarget::Kind;
  const auto target = [](Kind kind) {
    return at(&Answer::plan, &AccuracyPlan::target,
              [kind](const AccuracyTarget& one) { return one.kind == kind ? Json(one.value) : Json(); });
  };
  const auto of = [](const auto&... parts) { return at(&Answer::request, parts...); };
  const auto names = [](const std::vector<sim::Estimator>& all) { return accuracy_array(all, name_in_json); };
  const auto axes = [](const std::vector<AccuracyAxis>& all) {
    return all.empty() ? Json::array({"estimator"}) : accuracy_array(all, name_in_json);
  };
  const auto seeds = [](const Request& request) {
    return request.seeds ? Json(fmt::format("{}:{}", request.seeds->first, request.seeds->last)) : Json();
  };
  const auto crease = [](const Request& request) { return request.crease ? Json(*request.crease) : left_out(); };
  static const Fields<Answer> fields{
      {"scene", "", "as it was named", of(&Request::scene, &sim::SceneRequest::name)},
      {"target_noise", "", "noise to reach", target(Kind::noise)},
      {"target_error", "", "noise and bias together to reach", target(Kind::total)},
      {"time_budget", "s", "that a run may take", target(Kind::seconds)},
      {"estimators", "", "in question; none: all", of(&Request::estimators, names)},
      {"most_rays", "", "pieces of photon paths that a run may have", of(&Request::most_rays)},
      {"reference", "", "the file of what bias is judged by", of(&Request::reference)},
      {"axes", "", "where accuracy costs time", of(&Request::axes, axes)},
      {"effort", "", "how long planning may take", of(&Request::effort, name_in_json)},
      {"check", "", "the answer is run once", of(&Request::check)},
      {"discs", "", "the file of the discs in question", of(&Request::discs)},
      {"disc_radius", "", "around which radii were tried, if it was given", &Answer::disc_radius},
      {"materials", "", "of the faces in question", of(&Request::faces, &sim::FaceNames::materials)},
      {"groups", "", "of the faces in question", of(&Request::faces, &sim::FaceNames::groups)},
      {"seeds", "", "with which the answer is run again", of(seeds)},
      {"samples", "", "of the scene, or discs of the file", &Answer::samples},
      {"front_facing", "", "light that arrives from behind does not count", of(&Request::front_facing)},
      {"crease", "degrees", "angle from which edges are sharp, if it was given", of(crease)}};
  return fields;
}

}  // namespace

Json inputs_json(const AccuracyAnswer& answer) { return json_of(accuracy_input_fields(), answer); }

Json to_json(const AccuracyAnswer& answer) { return json_of(accuracy_answer_fields(), answer); }

Columns accuracy_columns() { return columns_of(accuracy_row_fields()); }

std::vector<Json> accuracy_rows(const AccuracyAnswer& answer) {
  std::vector<Json> rows;
  const auto add = [&](const AccuracyRow& row) { rows.push_back(cells_of(accuracy_row_fields(), row)); };
  add({.answer = &answer, .role = "answer", .point = &answer.plan.answer});
  for (const AccuracyPoint& point : answer.plan.rivals) add({.answer = &answer, .role = "rival", .point = &point});
  for (const AccuracyPoint& point : answer.plan.points) add({.answer = &answer, .role = "point", .point = &point});
  for (const AccuracyRerun& run : answer.reruns) add({.answer = &answer, .role = "run", .run = &run});
  for (const AxisPoint& point : answer.axes) add({.answer = &answer, .role = point.axis, .axis = &point});
  return rows;
}

std::vector<FieldText> describe_accuracy() {
  std::vector<FieldText> all;
  const auto add = [&](const std::string& part, const auto& fields) {
    for (FieldText& field : describe_fields(fields)) {
      if (!field.name.empty()) field.name = part + field.name;
      all.push_back(std::move(field));
    }
  };
  add("inputs.", accuracy_input_fields());
  add("", accuracy_answer_fields());
  add("points.", accuracy_row_fields());
  add("answer.", chosen_point_fields());
  add("reference.", pilot_judge_fields());
  add("reruns.runs.", accuracy_rerun_fields());
  return all;
}

}  // namespace detp::validate
