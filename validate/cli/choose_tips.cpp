#include "choose_tips.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "measured_report.hpp"
#include "workload_options.hpp"

namespace detp::cli {
namespace {

using validate::Tip;
using validate::TipInput;
using validate::TipKind;

constexpr std::array tip_inputs{TipInput::disc_radius, TipInput::rays, TipInput::threads};

/// A number >= 1, rounded to three digits.
double three_digits(double number) {
  const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(number)) - 2));
  return std::round(number / unit) * unit;
}

/// "above d = 0.31 (2.6 times)", "below 3000 rays (0.03 times)" or "with --threads 1".
std::string where(const Tip& tip) {
  if (tip.input == TipInput::threads) return fmt::format("with --threads {:.0f}", tip.at);
  const char* const side = tip.ratio > 1 ? "above" : "below";
  if (tip.input == TipInput::rays)
    return fmt::format("{} {:.0f} rays ({:.3g} times)", side, three_digits(tip.at), tip.ratio);
  return fmt::format("{} d = {:.3g} ({:.3g} times)", side, tip.at, tip.ratio);
}

std::string tip_text(const Tip& tip) {
  const auto technique = name(tip.candidate.technique);
  switch (tip.kind) {
    case TipKind::technique:
      return fmt::format("{} overtakes {}", technique, where(tip));
    case TipKind::not_ruled_out:
      return fmt::format("{} is no longer ruled out {}", technique, where(tip));
    case TipKind::parameters:
      return fmt::format("{} is {:.0f} % faster {}", title(tip.candidate), 100 * validate::distinguishable, where(tip));
    case TipKind::threads:
      return fmt::format("{} {} faster {}", threads_text(tip.threads), tip.threads == 1 ? "is" : "are", where(tip));
  }
  return "";
}

/// The inputs for which no tip has another technique, and their ranges: "d from 0.25 to 4 times this one".
std::vector<std::string> without_other_technique(const validate::Tips& tips) {
  const auto tips_technique = [&](TipInput input) {
    return std::any_of(tips.tips.begin(), tips.tips.end(), [&](const Tip& tip) {
      return tip.input == input && (tip.kind == TipKind::technique || tip.kind == TipKind::not_ruled_out);
    });
  };
  std::vector<std::string> texts;
  for (const TipInput input : tip_inputs) {
    const validate::TipRange& range = tips.range(input);
    if (tips_technique(input) || range.least == range.most) continue;
    texts.push_back(input == TipInput::disc_radius ? fmt::format("d from {:.3g} to {:.3g}", range.least, range.most)
                    : input == TipInput::rays
                        ? fmt::format("{:.0f} to {:.0f} rays", three_digits(range.least), three_digits(range.most))
                        : fmt::format("{:.0f} to {:.0f} threads", range.least, range.most));
  }
  return texts;
}

}  // namespace

void add_tips(Json& json, const ChooseAnswer& answer) {
  const validate::Tips& tips = answer.tips;
  json["tips"] = Json::array();
  for (const Tip& tip : tips.tips) {
    Json& one =
        json["tips"].emplace_back(Json{{"input", detp::name(tip.input)},
                                       {"at", tip.input == TipInput::disc_radius ? Json(tip.at) : whole(tip.at)},
                                       {"ratio", tip.ratio},
                                       {"change", detp::name(tip.kind)},
                                       {"technique", name(tip.candidate.technique)}});
    if (tip.kind == TipKind::not_ruled_out) continue;
    one["parameters"] = to_json(tip.candidate);
    one["threads"] = tip.threads;
  }
  for (const TipInput input : tip_inputs) {
    const validate::TipRange& range = tips.range(input);
    const bool length = input == TipInput::disc_radius;
    json["tips_range"][std::string(detp::name(input))] =
        length ? Json::array({range.least, range.most}) : Json::array({whole(range.least), whole(range.most)});
  }
  json["tips_seconds"] = answer.tips_seconds;
}

std::string tips_line(const ChooseAnswer& answer) {
  const validate::Tips& tips = answer.tips;
  std::vector<std::string> texts;
  for (const Tip& tip : tips.tips) texts.push_back(tip_text(tip));
  const bool all_examined = !answer.by_sample() || answer.choice.unexamined.empty();
  if (const auto inputs = without_other_technique(tips); !inputs.empty())
    texts.push_back(fmt::format("no other technique{} wins for {}", all_examined ? "" : " that was examined",
                                fmt::join(inputs, ", for ")));
  if (tips.stopped()) texts.push_back("stopped before all inputs were examined");
  return fmt::format("tips      {}{}", answer.analysis ? "as predicted, " : "", fmt::join(texts, "; "));
}

}  // namespace detp::cli
