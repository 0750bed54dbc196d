#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "accuracy_answer.hpp"

/// The answer in words.
namespace detp::validate {
namespace {

/// Where the mean bias is clear.
std::string light_words(const AccuracyPoint& point) {
  constexpr double clear = 3;  // standard errors
  const auto& [bias, error] = point.mean_bias;
  if (std::abs(bias) <= clear * error || std::abs(bias) < 0.001) return "";
  return fmt::format(" ({} of the light is {})", percent(std::abs(bias)), bias > 0 ? "gained" : "lost");
}

std::string not_reached_words(const AccuracyAnswer& answer) {
  const AccuracyPoint& best = answer.plan.answer;
  const AccuracyTarget& target = answer.plan.target;
  const std::string what = percent(target.value) + (target.kind == AccuracyTarget::Kind::noise ? " noise" : " error");
  const std::string why =
      best.total.low < target.value
          ? fmt::format("may be reached, but the bias is not known well enough: {}. --effort thorough knows more",
                        bias_words(best))
          : fmt::format("is not reached: the least bias of the estimators tried is {}", percent(answer.plan.floor));
  return fmt::format("{} {}. Nearest: {} in {:.2g} s, {}.", what, why, percent(best.total.value), best.seconds,
                     way_words(answer, best));
}

std::string reached_words(const AccuracyAnswer& answer) {
  const AccuracyPoint& best = answer.plan.answer;
  const AccuracyTarget& target = answer.plan.target;
  if (target.kind == AccuracyTarget::Kind::seconds)
    return fmt::format("in {:.3g} s: {} total ({} to {}), {} noise, bias {}: {}.", target.value,
                       percent(best.total.value), percent(best.total.low), percent(best.total.high),
                       percent(best.noise.value), bias_words(best), way_words(answer, best));
  return fmt::format("{} {} takes {}: {:.2g} s ({:.2g} to {:.2g}){}. Bias: {}{}; total: {} ({:.2g} to {:.2g}).",
                     percent(target.value), name(target.kind), way_words(answer, best), best.seconds,
                     best.seconds / seconds_factor, seconds_factor * best.seconds,
                     best.gathers() ? "" : fmt::format(", of which {:.2g} s traces photons", best.trace_seconds),
                     bias_words(best), light_words(best), percent(best.total.value), 100 * best.total.low,
                     100 * best.total.high);
}

std::string check_words(const AccuracyAnswer& answer) {
  const AccuracyCheck& check = *answer.check;
  const bool same = check.point.rays == answer.plan.answer.rays;
  std::string text =
      fmt::format(" Run once to check{}: {} noise{}, {:.2g} s.",
                  same ? "" : ", before the check: " + way_words(answer, check.point), percent(check.noise),
                  check.error ? fmt::format(", {} total", percent(*check.error)) : "", check.seconds);
  if (check.share_within)
    text += fmt::format(" {} of the samples are within {}.", percent(*check.share_within), percent(answer.within()));
  return text;
}

}  // namespace

std::string percent(double share) { return fmt::format("{:.2g} %", 100 * share); }

std::string bias_words(const AccuracyPoint& point) {
  const RootInterval& bias = point.bias;
  if (bias.low > 0) return fmt::format("{} ({:.2g} to {:.2g})", percent(bias.value), 100 * bias.low, 100 * bias.high);
  return bias.high > 0 ? "at most " + percent(bias.high) : "none";
}

std::string setting_words(const AccuracyAnswer& answer, const AccuracyPoint& point) {
  if (point.radius > 0) return fmt::format("d = {:.2g} %", 100 * point.radius / answer.side);
  return point.nearest > 0 ? fmt::format("k = {}", point.nearest) : "";
}

std::string way_words(const AccuracyAnswer& answer, const AccuracyPoint& point) {
  if (point.gathers()) return fmt::format("{:.3g} backward paths of each sample, estimator gather", point.rays);
  std::string text = fmt::format("{:.3g} photon paths ({:.3g} pieces)", point.photons, point.rays);
  if (point.radius > 0)
    text += fmt::format(" with radius {:.3g} ({:.2g} % of the scene)", point.radius, 100 * point.radius / answer.side);
  if (point.nearest > 0) text += fmt::format(" with k = {}", point.nearest);
  return text + fmt::format(", estimator {}", name(point.estimator));
}

std::string command_of(const AccuracyAnswer& answer, const AccuracyPoint& point) {
  std::string text = fmt::format("{} --{} {:.3g} --estimator {}", answer.request.command,
                                 point.gathers() ? "paths" : "rays", point.rays, name(point.estimator));
  if (point.radius > 0) text += fmt::format(" --disc-radius {:.4g}", point.radius);
  if (point.nearest > 0) text += fmt::format(" --nearest {}", point.nearest);
  return text + answer.request.command_end;
}

std::string rivals_words(const AccuracyAnswer& answer) {
  std::string text = fmt::format("{} is best", name(answer.plan.answer.estimator));
  const AccuracyTarget& target = answer.plan.target;
  for (const AccuracyPoint& rival : answer.plan.rivals) {
    text += fmt::format("; {}", name(rival.estimator));
    if (target.kind == AccuracyTarget::Kind::seconds || !answer.plan.reached)
      text += fmt::format(" has {}", percent(rival.total.value));
    else if (!reaches(rival, target))
      text += fmt::format(" does not reach it: its bias is {}", bias_words(rival));
    else if (target.kind == AccuracyTarget::Kind::noise && rival.bias.value > target.value)
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
  for (const AccuracyRerun& one : answer.reruns) {
    noise.push_back(one.noise);
    seconds.push_back(one.seconds);
  }
  return fmt::format(
      "{} runs with seeds {} to {}: noise {} ({} to {}), inside the interval in {}; {:.2g} s ({:.2g} to {:.2g})",
      noise.size(), answer.reruns.front().seed, answer.reruns.back().seed, percent(median(noise)),
      percent(std::ranges::min(noise)), percent(std::ranges::max(noise)), answer.inside(), median(seconds),
      std::ranges::min(seconds), std::ranges::max(seconds));
}

std::string judge_words(const AccuracyAnswer& answer) {
  const PilotJudge& judge = answer.pilot.judge;
  if (judge.kind == ReferenceKind::known) return "against the closed form of this scene.";
  std::string text = fmt::format("against {} backward paths of each of {} samples (error {})", judge.paths,
                                 judge.samples, percent(judge.error));
  if (judge.kind == ReferenceKind::both)
    text += fmt::format(
        " and {:.2g} photons for the {} of the light that these paths miss, extrapolated from two radii: blur common "
        "to both is not seen",
        static_cast<double>(judge.photons), percent(judge.missed_mean));
  return text + ".";
}

std::string answer_words(const AccuracyAnswer& answer) {
  std::string text = answer.plan.reached ? reached_words(answer) : not_reached_words(answer);
  if (answer.plan.answer.noise_weak) text += " The noise is weak: a few photons bring most of it in the pilot.";
  if (answer.check) return text + check_words(answer);
  return answer.no_check.empty() ? text : text + " " + answer.no_check;
}

}  // namespace detp::validate
