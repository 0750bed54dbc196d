#include "accuracy_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "detp/validate/cli/text/messages.hpp"
#include "detp/validate/cli/text/table.hpp"

/// The answer in words and tables.
namespace detp::cli {
namespace {

using validate::AccuracyPoint;
using validate::AccuracyTarget;

std::string percent(double share) { return fmt::format("{:.2g} %", 100 * share); }

std::string rays_words(double rays) { return fmt::format("{:.2g}", rays); }

/// "340 000 photon paths with discs of radius 0.021 (2.1 % of the scene), estimator disc".
std::string way(const AccuracyAnswer& answer, const AccuracyPoint& point) {
  if (gathers(point)) return fmt::format("{:.3g} backward paths of each sample, estimator gather", point.rays);
  std::string text = fmt::format("{:.3g} photon paths ({:.3g} pieces)", point.photons, point.rays);
  if (point.radius > 0)
    text += fmt::format(" with radius {:.3g} ({:.2g} % of the scene)", point.radius, 100 * point.radius / answer.side);
  if (point.nearest > 0) text += fmt::format(" with k = {}", point.nearest);
  return text + fmt::format(", estimator {}", name(point.estimator));
}

/// "9 % (8 to 10)", "at most 2 %".
std::string bias_words(const AccuracyPoint& point) {
  if (point.bias_low > 0)
    return fmt::format("{} ({:.2g} to {:.2g})", percent(point.bias), 100 * point.bias_low, 100 * point.bias_high);
  return point.bias_high > 0 ? "at most " + percent(point.bias_high) : "none";
}

/// Where the mean bias is clear.
std::string light_words(const AccuracyPoint& point) {
  constexpr double clear = 3;  // standard errors
  if (std::abs(point.mean_bias) <= clear * point.mean_bias_error || std::abs(point.mean_bias) < 0.001) return "";
  return fmt::format(" ({} of the light is {})", percent(std::abs(point.mean_bias)),
                     point.mean_bias > 0 ? "gained" : "lost");
}

std::string error_words(const AccuracyPoint& best) {
  return fmt::format("Bias: {}{}; total: {} ({:.2g} to {:.2g}). ", bias_words(best), light_words(best),
                     percent(best.total), 100 * best.total_low, 100 * best.total_high);
}

std::string rivals_words(const AccuracyAnswer& answer) {
  std::string text = fmt::format("{} is best", name(answer.plan.answer.estimator));
  const AccuracyTarget& target = answer.plan.target;
  for (const AccuracyPoint& rival : answer.plan.rivals) {
    text += fmt::format("; {}", name(rival.estimator));
    if (target.kind == AccuracyTarget::Kind::seconds || !answer.plan.reached)
      text += fmt::format(" has {}", percent(rival.total));
    else if (!reaches(rival, target))
      text += fmt::format(" does not reach it: its bias is {}", bias_words(rival));
    else if (target.kind == AccuracyTarget::Kind::noise && rival.bias > target.value)
      text += fmt::format(" is left out for its bias, {}", bias_words(rival));
    else if (std::ranges::find(answer.plan.ties, rival.estimator) != answer.plan.ties.end())
      text += fmt::format(" is about as fast (bias {})", bias_words(rival));
    else
      text += fmt::format(" takes {:.2g} times as long (bias {})", rival.seconds / answer.plan.answer.seconds,
                          bias_words(rival));
  }
  if (answer.plan.gather_misses)
    text += fmt::format("; gather is left out: it misses up to {} of the light", percent(*answer.plan.gather_misses));
  return text;
}

std::string reruns_words(const AccuracyAnswer& answer) {
  std::vector<double> noise;
  std::vector<double> seconds;
  for (const validate::AccuracyRerun& one : answer.reruns) {
    noise.push_back(one.noise);
    seconds.push_back(one.seconds);
  }
  return fmt::format(
      "{} runs with seeds {} to {}: noise {} ({} to {}), inside the interval in {}; {:.2g} s ({:.2g} to {:.2g})",
      noise.size(), answer.reruns.front().seed, answer.reruns.back().seed, percent(validate::median(noise)),
      percent(std::ranges::min(noise)), percent(std::ranges::max(noise)), inside(answer), validate::median(seconds),
      std::ranges::min(seconds), std::ranges::max(seconds));
}

/// The curve has a point with the answer's number of rays.
bool is_answer(const AccuracyAnswer& answer, const AccuracyPoint& point) {
  constexpr double alike = 0.01;
  const AccuracyPoint& best = answer.plan.answer;
  return point.estimator == best.estimator && std::abs(point.rays / best.rays - 1) < alike &&
         std::abs(point.radius - best.radius) <= alike * best.radius;
}

/// A table for each axis.
std::string axes_text(const AccuracyAnswer& answer, const Screen& screen) {
  std::string text;
  for (std::size_t i = 0; i < answer.axes.size();) {
    const std::string axis = answer.axes[i].axis;
    TextTable table({{.head = axis, .align = Align::left},
                     {.head = "error of", .align = Align::left},
                     {.head = "error"},
                     {.head = "from"},
                     {.head = "to"},
                     {.head = "seconds"},
                     {.head = "1/(error² s)"}});
    for (; i < answer.axes.size() && answer.axes[i].axis == axis; ++i) {
      const validate::AxisPoint& point = answer.axes[i];
      table.add({{point.setting},
                 {point.quantity},
                 {percent(point.error)},
                 {point.interval ? percent(point.interval->low) : ""},
                 {point.interval ? percent(point.interval->high) : ""},
                 {fmt::format("{:.2g}", point.seconds)},
                 {point.error > 0 ? fmt::format("{:.2g}", point.merit()) : ""}});
    }
    text += table.text(screen) + "\n";
  }
  return text;
}

std::string bias_source(const AccuracyAnswer& answer) {
  const validate::PilotJudge& judge = answer.pilot.judge;
  if (judge.kind == validate::ReferenceKind::known) return "against the closed form of this scene.";
  std::string text = fmt::format("against {} backward paths of each of {} samples (error {})", judge.paths,
                                 judge.samples, percent(judge.error));
  if (judge.kind == validate::ReferenceKind::both)
    text += fmt::format(
        " and {:.2g} photons for the {} of the light that these paths miss, extrapolated from two radii: blur common "
        "to both is not seen",
        static_cast<double>(judge.photons), percent(judge.missed_mean));
  return text + ".";
}

}  // namespace

std::string setting_words(const AccuracyAnswer& answer, const AccuracyPoint& point) {
  if (gathers(point)) return "";
  if (point.radius > 0) return fmt::format("d = {:.2g} %", 100 * point.radius / answer.side);
  return point.nearest > 0 ? fmt::format("k = {}", point.nearest) : "";
}

std::string answer_words(const AccuracyAnswer& answer) {
  const AccuracyPoint& best = answer.plan.answer;
  const AccuracyTarget& target = answer.plan.target;
  std::string text;
  if (!answer.plan.reached) {
    const std::string what = percent(target.value) + (target.kind == AccuracyTarget::Kind::noise ? " noise" : " error");
    if (best.total_low < target.value)
      text = fmt::format("{} may be reached, but the bias is not known well enough: {}. --effort thorough knows more. ",
                         what, bias_words(best));
    else
      text = fmt::format("{} is not reached: the least bias of the estimators tried is {}. ", what,
                         percent(answer.plan.floor));
    text += fmt::format("Nearest: {} in {:.2g} s, {}. ", percent(best.total), best.seconds, way(answer, best));
  } else if (target.kind == AccuracyTarget::Kind::seconds) {
    text = fmt::format("in {:.3g} s: {} total ({} to {}), {} noise, bias {}: {}. ", target.value, percent(best.total),
                       percent(best.total_low), percent(best.total_high), percent(best.noise), bias_words(best),
                       way(answer, best));
  } else {
    text = fmt::format("{} {} takes {}: {:.2g} s ({:.2g} to {:.2g}){}. ", percent(target.value),
                       target.kind == AccuracyTarget::Kind::noise ? "noise" : "error", way(answer, best), best.seconds,
                       best.seconds / seconds_factor, seconds_factor * best.seconds,
                       gathers(best) ? "" : fmt::format(", of which {:.2g} s traces photons", best.trace_seconds));
    text += error_words(best);
  }
  if (best.noise_weak) text += "The noise is weak: a few photons bring most of it in the pilot. ";
  if (answer.check)
    text += fmt::format("Run once to check{}: {} noise{}, {:.2g} s. ",
                        answer.checked.rays == best.rays ? "" : ", before the check: " + way(answer, answer.checked),
                        percent(answer.check->noise),
                        answer.check->error ? fmt::format(", {} total", percent(*answer.check->error)) : "",
                        answer.check->seconds);
  else if (!answer.no_check.empty())
    text += answer.no_check + " ";
  if (answer.check && answer.check->share_within)
    text += fmt::format("{} of the samples are within {}. ", percent(*answer.check->share_within),
                        percent(within_of(target)));
  text.pop_back();  // the space after the last sentence
  return text;
}

std::size_t inside(const AccuracyAnswer& answer) {
  const AccuracyPoint& best = answer.plan.answer;
  return static_cast<std::size_t>(std::ranges::count_if(answer.reruns, [&](const validate::AccuracyRerun& one) {
    return one.noise >= best.noise_low && one.noise <= best.noise_high;
  }));
}

std::string to_text(const AccuracyAnswer& answer, const Screen& screen) {
  std::string text = wrapped("answer    " + answer_words(answer), screen.text_width(), 10);
  text += wrapped(
      "          " + fmt::format("In {:.2g} s, twice the time: {} total ({} noise, bias {}): {}. With the answer's "
                                 "setting, the total falls as the time to the power {:.2f} ({:.2f} to {:.2f}).",
                                 answer.in_time.seconds, percent(answer.in_time.total), percent(answer.in_time.noise),
                                 bias_words(answer.in_time), way(answer, answer.in_time), answer.plan.answer.slope,
                                 answer.plan.answer.slope_low, answer.plan.answer.slope_high),
      screen.text_width(), 10);
  text += "command   " + command_of(answer, answer.plan.answer) + "\n";  // one line, to be pasted
  text += wrapped("estimator " + rivals_words(answer), screen.text_width(), 10);
  if (!answer.reruns.empty()) text += wrapped("runs      " + reruns_words(answer), screen.text_width(), 10);
  text += "\n";
  TextTable table({{.head = "total"},
                   {.head = "noise"},
                   {.head = "bias"},
                   {.head = "pieces (paths)"},
                   {.head = "setting", .align = Align::left},
                   {.head = "estimator", .align = Align::left},
                   {.head = "seconds"},
                   {.head = "", .align = Align::left}});
  const auto add = [&](const AccuracyPoint& point, const std::string& remark) {
    table.add({{percent(point.total)},
               {percent(point.noise)},
               {point.bias_low > 0    ? percent(point.bias)
                : point.bias_high > 0 ? "< " + percent(point.bias_high)
                                      : "0"},
               {rays_words(point.rays) + (gathers(point) ? " a sample" : "")},
               {setting_words(answer, point)},
               {std::string(name(point.estimator))},
               {fmt::format("{:.2g}", point.seconds)},
               {remark}});
  };
  std::vector<AccuracyPoint> shown;
  for (const AccuracyPoint& point : answer.plan.points)
    if (point.on_frontier && point.total < 1 && !is_answer(answer, point)) shown.push_back(point);
  std::ranges::sort(shown, {}, &AccuracyPoint::seconds);
  // of points that are equally fast, the most accurate one
  std::vector<AccuracyPoint> best;
  for (const AccuracyPoint& point : shown)
    if (best.empty() || point.total < best.back().total) best.push_back(point);
  // those around the answer
  constexpr std::size_t rows_shown = 7;
  const auto distance = [&](const AccuracyPoint& point) {
    return std::abs(std::log(point.seconds / answer.plan.answer.seconds));
  };
  while (best.size() > rows_shown)
    best.erase(distance(best.front()) > distance(best.back()) ? best.begin() : best.end() - 1);
  bool answered = false;
  for (const AccuracyPoint& point : best) {
    if (!answered && point.seconds >= answer.plan.answer.seconds) {
      add(answer.plan.answer, "<- answer");
      answered = true;
    }
    add(point, "");
  }
  if (!answered) add(answer.plan.answer, "<- answer");
  text += table.text(screen) + "\n" + axes_text(answer, screen);
  text +=
      wrapped(fmt::format("noise, bias, total: root mean square over {}, relative to the root mean square irradiance. "
                          "Seconds: wall clock, tracing included. Bias: {}",
                          "the samples by area", bias_source(answer)),
              screen.text_width(), 0);
  return text + fmt::format("planning  {:.2g} s: a pilot of {:.2g} pieces{}\n", answer.seconds, answer.pilot.rays,
                            answer.check ? ", one check" : "");
}

}  // namespace detp::cli
