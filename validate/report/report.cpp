#include "report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/validate/picture/labels.hpp"
#include "parts.hpp"

namespace detp::validate {
namespace {

using Words = std::vector<std::string>;

/// Seconds that a part takes, by the answer of `scene`: for each second of tracing and of reading, and for each 100 000 samples and triangles.
struct ForecastRule {
  double tracing = 0;
  double reading = 0;
  double samples = 0;
  double triangles = 0;
  double fixed = 0;

  [[nodiscard]] double seconds(const Json& scene, double times_the_rays = 1) const {
    constexpr double many = 1e5;
    const auto of = [&](const char* key) { return number(scene, key).value_or(0); };
    return tracing * (times_the_rays * of("trace_seconds")) + reading * of("read_seconds") +
           samples * of("samples") / many + triangles * of("triangles") / many + fixed;
  }
};

/// The options that say what the scene is.
Words scene_words(const ReportRequest& request) {
  Words all;
  if (request.samples) all = all + Words{"--samples", fmt::format("{:.9g}", *request.samples)};
  if (request.lights) all = all + Words{"--light", *request.lights};
  if (request.up) all = all + Words{"--up", *request.up};
  if (request.front_facing) all.emplace_back("--front-facing");
  return all + request.common;
}

Words workload_words(const ReportRequest& request) {
  Words all;
  if (request.rays) all = all + Words{"--rays", fmt::format("{:.9g}", *request.rays)};
  if (request.disc_radius) all = all + Words{"--disc-radius", *request.disc_radius};
  return all + scene_words(request);
}

std::string comma_list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values)
    text += fmt::format("{}{}", text.empty() ? "" : ",",
                        value < 1000 ? fmt::format("{:.5g}", value) : fmt::format("{:.0f}", value));
  return text;
}

/// Numbers of rays around `here`, which is among them.
std::string map_rays(double here, bool quick) {
  std::vector<double> rays;
  for (const double factor :
       quick ? std::vector{0.01, 0.1, 1.0, 3.0} : std::vector{0.001, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0})
    if (const double one = factor == 1 ? here : std::round(factor * here); one >= 10) rays.push_back(one);
  return comma_list(rays);
}

std::string map_radii(double here, bool quick) {
  std::vector<double> radii;
  for (int step = quick ? -2 : -4; step <= (quick ? 2 : 4); ++step) radii.push_back(std::ldexp(here, step));
  return comma_list(radii);
}

/// The parts after `scene`, in the order of what the page can least do without.
std::vector<ReportPart> parts_after_scene(const ReportRequest& request, const Json& scene) {
  // Least squares of the relative errors on 17 scenes, 100 000 rays (AMD EPYC, Zen 3, two threads). `accuracy` does not take --rays, and by
  // default it makes further pilots and runs its answer: 2.9 times as long in the geometric mean, from 1 to 12 times.
  const bool quick = request.quick;
  const ForecastRule of_choice{.tracing = 11, .samples = 0.4};
  const ForecastRule of_accuracy{.tracing = 1.06, .reading = 1.42, .samples = 3.7, .fixed = 0.53};
  const ForecastRule of_map = quick ? ForecastRule{.tracing = 7.7, .reading = 5.5}
                                    : ForecastRule{.tracing = 21.3, .reading = 17.2, .fixed = 2.15};
  const ForecastRule of_picture{.tracing = 1.5, .reading = 1.5, .samples = 0.3, .triangles = 0.5, .fixed = 0.4};
  const ForecastRule of_verdicts =
      quick ? ForecastRule{.tracing = 0.79, .reading = 0.62, .samples = 0.085, .triangles = 0.18}
            : ForecastRule{.tracing = 11.2, .samples = 13.4, .triangles = 2.9};
  const double usual_rays = 1e5 / std::max(1.0, number(scene, "rays").value_or(0));
  const Words target = request.target_error ? Words{"--target-error", *request.target_error}
                                            : Words{"--target-noise", request.target_noise.value_or("5%")};
  return {{.name = "choice",
           .words = Words{"choose", request.scene} + workload_words(request) + Words{"--analyze"},
           .forecast_seconds = of_choice.seconds(scene)},
          {.name = "picture",
           .words = Words{"run", request.scene} + workload_words(request) +
                    Words{"--standard-error", "--picture-width", "400", "--picture", std::string(picture_name)},
           .forecast_seconds = of_picture.seconds(scene)},
          {.name = "accuracy",
           .words = Words{"accuracy", request.scene} + target + scene_words(request) +
                    (quick ? Words{"--effort", "quick"} : Words{}),
           .forecast_seconds = (quick ? 1 : 2.9) * of_accuracy.seconds(scene, usual_rays),
           .may_fail = true},
          {.name = "map",
           .words = Words{"choose", request.scene, "--map", "--rays", map_rays(request.rays.value_or(1e5), quick),
                          "--disc-radius", map_radii(number(scene, "disc_radius").value_or(0), quick)} +
                    scene_words(request),
           .forecast_seconds = of_map.seconds(scene)},
          {.name = "verdicts",
           .words = Words{"validate", request.scene} + workload_words(request) +
                    Words{"--experiments", quick ? "effects" : "choice,effects"},
           .forecast_seconds = of_verdicts.seconds(scene)}};
}

/// Of the candidate in the list with the same technique and parameters.
Json predicted_error(const Json& candidates, const Json& wanted) {
  for (const Json& one : candidates)
    if (words(one, "technique") == words(wanted, "technique") && list(one, "parameters") == list(wanted, "parameters"))
      return one.value("predicted_seconds_error", Json());
  return wanted.value("predicted_seconds_error", Json());
}

Json accuracy_json(const Json& accuracy) {
  const Json& answer = list(accuracy, "answer");
  if (answer.empty()) return nullptr;
  const auto noise = number(list(accuracy, "inputs"), "target_noise");
  const auto target = noise ? noise : number(list(accuracy, "inputs"), "target_error");
  Json json{{"target", target ? fmt::format("{} {}", percent_label(*target), noise ? "noise" : "error") : ""},
            {"seconds", answer.value("predicted_seconds", Json())},
            {"seconds_interval", answer.value("predicted_seconds_interval", Json())}};
  for (const char* key : {"photons", "rays"}) json[key] = answer.value(key, Json());
  json["estimator"] = words(answer, "estimator");
  for (const char* key : {"disc_radius", "error", "error_interval"}) json[key] = answer.value(key, Json());
  json["reached"] = answer.value("reached", true);
  json["command"] = words(answer, "command");
  return json;
}

std::string answer_text(const Json& answer, const Json& inputs) {
  std::string text;
  if (!words(answer, "technique").empty()) {
    const std::string parameters = parameter_words(answer);
    text = fmt::format(
        "{} {} and {} discs of radius {:.3g} take {} with {}{}", count_words(number(inputs, "rays").value_or(0)),
        words(inputs, "field") == "photons" ? "pieces of photon paths" : "rays",
        count_words(number(inputs, "samples").value_or(0)), number(inputs, "disc_radius").value_or(0),
        seconds_words(number(answer, "predicted_seconds").value_or(0), number(answer, "predicted_seconds_error")),
        words(answer, "technique"), parameters.empty() ? "" : ", " + parameters);
    const std::string measured = shown_seconds(answer, "measured_seconds", "measured_spread");
    text += measured.empty() ? ". " : fmt::format("; measured: {}. ", measured);
  }
  const Json& accuracy = list(answer, "accuracy");
  if (const auto seconds = number(accuracy, "seconds"); seconds && accuracy.value("reached", true))
    text += fmt::format("{} costs {} ({} to {}): {}", words(accuracy, "target"), seconds_label(*seconds),
                        seconds_label(list(accuracy, "seconds_interval")[0].get<double>()),
                        seconds_label(list(accuracy, "seconds_interval")[1].get<double>()), words(accuracy, "command"));
  return text;
}

/// The member `answer` of the report, from its parts.
Json answer_json(const Json& report) {
  const Json& choice = answer_of(report, "choice");
  Json answer{{"text", ""}};
  if (const Json& best = list(choice, "choice"); !best.empty()) {
    for (const char* key :
         {"technique", "parameters", "threads", "predicted_seconds", "measured_seconds", "measured_spread"})
      if (best.contains(key)) answer[key] = best[key];
    answer["predicted_seconds_error"] = predicted_error(list(choice, "candidates"), best);
  }
  answer["accuracy"] = accuracy_json(answer_of(report, "accuracy"));
  answer["text"] = answer_text(answer, list(choice, "inputs"));
  return answer;
}

const Fields<ReportRequest>& input_fields() {
  using Request = ReportRequest;
  static const Fields<Request> fields{
      {"scene", "", "a mesh or a built-in scene", &Request::scene},
      {"rays", "", "asked for", &Request::rays},
      {"disc_radius", "length or share", "asked for", &Request::disc_radius},
      {"samples", "", "asked for", &Request::samples},
      {"light", "", "lights placed in the scene", &Request::lights},
      {"up", "", "which way is up", &Request::up},
      {"front_facing", "", "light from behind does not count", &Request::front_facing},
      {"target_error", "", "noise and bias together, whose cost is asked for", &Request::target_error},
      {"target_noise", "", "noise whose cost is asked for",
       [](const Request& one) {
         return one.target_noise || one.target_error ? json_value(one.target_noise) : Json("5%");
       }},
      {"quick", "", "smaller map, short pilots, closed forms of one technique", &Request::quick}};
  return fields;
}

/// The report while it is made.
class Report {
 public:
  Report(const ReportRequest& request, const Ask& ask, std::stop_token stop, const sim::ReportPhase& progress)
      : request_(request), ask_(ask), stop_(std::move(stop)), progress_(progress) {
    json_["inputs"] = json_of(input_fields(), request);
    json_["answer"] = Json::object();
    json_["warnings"] = Json::array();
    json_["parts"] = Json::array();
  }

  Json make() {
    // `scene` is short, and says how long the others will take.
    if (add({.name = "scene", .words = Words{"scene", request_.scene} + workload_words(request_)})) {
      const std::vector<ReportPart> parts = parts_after_scene(request_, answer_of(json_, "scene"));
      forecast_ = clock_.seconds();
      for (const ReportPart& part : parts) forecast_ += *part.forecast_seconds;
      json_["forecast_seconds"] = forecast_;
      for (const ReportPart& part : parts)
        if (!add(part)) break;
    }
    json_["answer"] = answer_json(json_);
    json_["seconds"] = clock_.seconds();
    json_["stopped"] = stopped_;
    return std::move(json_);
  }

 private:
  /// Returns false if a stop request ended the part.
  bool add(ReportPart part) {
    show(part.name, part.forecast_seconds.value_or(0));
    const sim::Stopwatch clock;
    try {
      part.answer = ask_(part.words);
      stopped_ = part.answer["stopped"] != false;
      for (const Json& warning : list(part.answer, "warnings"))
        if (std::ranges::find(json_["warnings"], warning) == json_["warnings"].end())
          json_["warnings"].push_back(warning);
    } catch (const sim::Stopped&) {
      stopped_ = true;
    } catch (const std::invalid_argument& error) {
      if (!part.may_fail) throw;
      part.not_made = error.what();
    }
    part.seconds = clock.seconds();
    json_["parts"].push_back(json_of(part_fields(), part));
    stopped_ = stopped_ || stop_.stop_requested();
    return !stopped_;
  }

  void show(const std::string& name, double forecast) {
    const double now = clock_.seconds();
    const double whole = std::max(forecast_, now + forecast);
    if (progress_)
      progress_({name, whole > 0 ? now / whole : 0, whole > 0 ? (now + forecast) / whole : 0, 0, forecast});
  }

  const ReportRequest& request_;
  const Ask& ask_;
  std::stop_token stop_;
  const sim::ReportPhase& progress_;
  sim::Stopwatch clock_;
  double forecast_ = 0;
  bool stopped_ = false;
  Json json_;
};

}  // namespace

std::string ReportPart::command() const {
  std::string text = "detp";
  for (const std::string& word : words) text += " " + shell_word(word);
  return text;
}

const Fields<ReportPart>& part_fields() {
  using Part = ReportPart;
  static const Fields<Part> fields{
      Field<Part>("name", "", "scene, choice, picture, accuracy, map or verdicts", &Part::name).in({{"part"}}),
      {"command", "", "that gives this part's answer", &Part::command},
      {"seconds", "s", "that it took", &Part::seconds},
      {"forecast_seconds", "s", "what was foreseen; null for the scene", &Part::forecast_seconds},
      Field<Part>("answer", "", "of the command, as its JSON", &Part::answer).in_json_alone(),
      Field<Part>("not_made", "", "why there is no answer", [](const Part& part) {
        return part.not_made.empty() ? left_out() : Json(part.not_made);
      }).in_json_alone()};
  return fields;
}

std::vector<FieldText> describe_report() { return describe_fields(input_fields()) + describe_fields(part_fields()); }

Json answer(const ReportRequest& request, const Ask& ask, const std::stop_token& stop,
            const sim::ReportPhase& progress) {
  return Report(request, ask, stop, progress).make();
}

}  // namespace detp::validate
