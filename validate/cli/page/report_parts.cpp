#include "report_parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "detp/validate/cli/text/words.hpp"
#include "detp/validate/picture/labels.hpp"
#include "detp/validate/report/parts.hpp"

namespace detp::cli {
namespace {

using validate::list;
using validate::number;
using validate::words;

/// Seconds that a part takes, by what `scene` found: for each second of tracing and of reading, and for each 100 000 samples and triangles.
struct ForecastRule {
  double tracing = 0;
  double reading = 0;
  double samples = 0;
  double triangles = 0;
  double fixed = 0;

  [[nodiscard]] double seconds(const ReportScale& scale) const {
    constexpr double many = 1e5;
    return tracing * scale.tracing_seconds + reading * scale.reading_seconds + samples * scale.samples / many +
           triangles * scale.triangles / many + fixed;
  }
};

void add(std::vector<std::string>& all, const std::vector<std::string>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// The options that say what the scene is.
std::vector<std::string> scene_words(const ReportOptions& options) {
  std::vector<std::string> all;
  if (options.samples) add(all, {"--samples", fmt::format("{:.9g}", *options.samples)});
  if (options.lights) add(all, {"--light", *options.lights});
  if (options.up) add(all, {"--up", *options.up});
  if (options.front_facing) add(all, {"--front-facing"});
  add(all, options.common);
  return all;
}

std::vector<std::string> workload_words(const ReportOptions& options) {
  std::vector<std::string> all;
  if (options.rays) add(all, {"--rays", fmt::format("{:.9g}", *options.rays)});
  if (options.radius) add(all, {"--disc-radius", *options.radius});
  add(all, scene_words(options));
  return all;
}

/// Numbers of rays around `here`, which is among them.
std::vector<double> map_rays(double here, bool quick) {
  std::vector<double> rays;
  const auto factors =
      quick ? std::vector{0.01, 0.1, 1.0, 3.0} : std::vector{0.001, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0};
  for (const double factor : factors)
    if (const double one = factor == 1 ? here : std::round(factor * here); one >= 10) rays.push_back(one);
  return rays;
}

std::vector<double> map_radii(double here, bool quick) {
  std::vector<double> radii;
  for (int step = quick ? -2 : -4; step <= (quick ? 2 : 4); ++step) radii.push_back(std::ldexp(here, step));
  return radii;
}

std::string comma_list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values)
    text += fmt::format("{}{}", text.empty() ? "" : ",",
                        value < 1000 ? fmt::format("{:.5g}", value) : fmt::format("{:.0f}", value));
  return text;
}

/// The candidate of the list with the same technique and parameters.
const Json& same_candidate(const Json& candidates, const Json& wanted) {
  for (const Json& one : candidates)
    if (words(one, "technique") == words(wanted, "technique") && list(one, "parameters") == list(wanted, "parameters"))
      return one;
  return wanted;
}

Json accuracy_answer(const Json& accuracy) {
  const Json& answer = list(accuracy, "answer");
  if (answer.empty()) return nullptr;
  const Json& inputs = list(accuracy, "inputs");
  const auto noise = number(inputs, "target_noise");
  const auto error = number(inputs, "target_error");
  const auto target = noise ? noise : error;
  return {{"target", target ? fmt::format("{} {}", validate::percent_label(*target), noise ? "noise" : "error") : ""},
          {"seconds", answer.value("predicted_seconds", Json())},
          {"seconds_interval", answer.value("predicted_seconds_interval", Json())},
          {"photons", answer.value("photons", Json())},
          {"rays", answer.value("rays", Json())},
          {"estimator", words(answer, "estimator")},
          {"disc_radius", answer.value("disc_radius", Json())},
          {"error", answer.value("error", Json())},
          {"error_interval", answer.value("error_interval", Json())},
          {"reached", answer.value("reached", true)},
          {"command", words(answer, "command")}};
}

std::string answer_text(const Json& answer, const Json& inputs) {
  std::string text;
  if (!words(answer, "technique").empty()) {
    const std::string parameters = validate::parameter_words(answer);
    text = fmt::format("{} {} and {} discs of radius {:.3g} take {} with {}{}",
                       validate::count_words(number(inputs, "rays").value_or(0)),
                       words(inputs, "field") == "photons" ? "pieces of photon paths" : "rays",
                       validate::count_words(number(inputs, "samples").value_or(0)),
                       number(inputs, "disc_radius").value_or(0),
                       validate::seconds_words(number(answer, "predicted_seconds").value_or(0),
                                               number(answer, "predicted_seconds_error")),
                       words(answer, "technique"), parameters.empty() ? "" : ", " + parameters);
    text += number(answer, "measured_seconds")
                ? fmt::format("; measured: {}. ", validate::seconds_words(*number(answer, "measured_seconds"),
                                                                          number(answer, "measured_spread")))
                : ". ";
  }
  const Json& accuracy = list(answer, "accuracy");
  if (const auto seconds = number(accuracy, "seconds"); seconds && accuracy.value("reached", true))
    text += fmt::format("{} costs {} ({} to {}): {}", words(accuracy, "target"), validate::seconds_label(*seconds),
                        validate::seconds_label(list(accuracy, "seconds_interval")[0].get<double>()),
                        validate::seconds_label(list(accuracy, "seconds_interval")[1].get<double>()),
                        words(accuracy, "command"));
  return text;
}

}  // namespace

std::string ReportPart::line() const {
  std::string text = "detp";
  for (const std::string& word : words) text += " " + shell_word(word);
  return text;
}

ReportPart scene_part(const ReportOptions& options) {
  ReportPart part{.name = "scene", .words = {"scene", options.scene}};
  add(part.words, workload_words(options));
  return part;
}

ReportScale scale_of(const Json& scene_answer) {
  return {.triangles = number(scene_answer, "triangles").value_or(0),
          .samples = number(scene_answer, "samples").value_or(0),
          .rays = number(scene_answer, "rays").value_or(0),
          .disc_radius = number(scene_answer, "disc_radius").value_or(0),
          .reading_seconds = number(scene_answer, "read_seconds").value_or(0),
          .tracing_seconds = number(scene_answer, "trace_seconds").value_or(0)};
}

std::vector<ReportPart> report_parts(const ReportOptions& options, const ReportScale& scale) {
  // Least squares of the relative errors on 17 scenes, 100 000 rays (AMD EPYC, Zen 3, two threads). `accuracy` does not take --rays, and by
  // default it makes further pilots and runs its answer: 2.9 times as long in the geometric mean, from 1 to 12 times.
  const bool quick = options.quick;
  const ForecastRule of_choice{.tracing = 11, .samples = 0.4};
  const ForecastRule of_accuracy{.tracing = 1.06, .reading = 1.42, .samples = 3.7, .fixed = 0.53};
  const ForecastRule of_map = quick ? ForecastRule{.tracing = 7.7, .reading = 5.5}
                                    : ForecastRule{.tracing = 21.3, .reading = 17.2, .fixed = 2.15};
  const ForecastRule of_verdicts =
      quick ? ForecastRule{.tracing = 0.79, .reading = 0.62, .samples = 0.085, .triangles = 0.18}
            : ForecastRule{.tracing = 11.2, .samples = 13.4, .triangles = 2.9};
  ReportScale usual_rays = scale;
  usual_rays.tracing_seconds *= 1e5 / std::max(1.0, scale.rays);
  ReportPart choice{.name = "choice", .words = {"choose", options.scene}};
  add(choice.words, workload_words(options));
  add(choice.words, {"--analyze"});
  ReportPart accuracy{.name = "accuracy", .words = {"accuracy", options.scene}, .may_fail = true};
  add(accuracy.words, options.error ? std::vector<std::string>{"--target-error", *options.error}
                                    : std::vector<std::string>{"--target-noise", options.noise.value_or("5%")});
  add(accuracy.words, scene_words(options));
  if (options.quick) add(accuracy.words, {"--effort", "quick"});
  const std::vector<double> rays = map_rays(options.rays.value_or(1e5), options.quick);
  const std::vector<double> radii = map_radii(scale.disc_radius, options.quick);
  ReportPart map{
      .name = "map",
      .words = {"choose", options.scene, "--map", "--rays", comma_list(rays), "--disc-radius", comma_list(radii)}};
  add(map.words, scene_words(options));
  ReportPart verdicts{.name = "verdicts", .words = {"validate", options.scene}};
  add(verdicts.words, workload_words(options));
  add(verdicts.words, {"--experiments", options.quick ? "effects" : "choice,effects"});
  choice.forecast = of_choice.seconds(scale);
  accuracy.forecast = (quick ? 1 : 2.9) * of_accuracy.seconds(usual_rays);
  map.forecast = of_map.seconds(scale);
  verdicts.forecast = of_verdicts.seconds(scale);
  return {choice, accuracy, map, verdicts};
}

Json report_answer(const Json& report) {
  const Json& choice = validate::answer_of(report, "choice");
  Json answer{{"text", ""}};
  if (const Json& best = list(choice, "choice"); !best.empty()) {
    const Json& candidate = same_candidate(list(choice, "candidates"), best);
    for (const char* key :
         {"technique", "parameters", "threads", "predicted_seconds", "measured_seconds", "measured_spread"})
      if (best.contains(key)) answer[key] = best[key];
    answer["predicted_seconds_error"] = candidate.value("predicted_seconds_error", Json());
  }
  answer["accuracy"] = accuracy_answer(validate::answer_of(report, "accuracy"));
  answer["text"] = answer_text(answer, list(choice, "inputs"));
  return answer;
}

}  // namespace detp::cli
