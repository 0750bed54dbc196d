#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "choose_parts.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/words.hpp"

namespace detp::cli {
namespace {

constexpr std::size_t most_names = 3;

/// A technique other than the choice.
struct Rival {
  Technique technique;
  double seconds;
  bool ruled_out = false;
  bool by_bound = false;      ///< `seconds` is the least that it could take
  bool extrapolated = false;  ///< its closed form
};

std::optional<Rival> nearest_rival(const ChooseAnswer& answer) {
  const Technique chosen = answer.choice.best().candidate.technique;
  std::optional<Rival> nearest;
  const auto consider = [&](const Rival& one) {
    if (one.technique != chosen && (!nearest || one.seconds < nearest->seconds)) nearest = one;
  };
  for (const auto& ranked : answer.choice.candidates)
    consider({ranked.candidate.technique, ranked.time.total(), false, false, !ranked.extrapolated.empty()});
  if (answer.by_sample())
    for (const validate::RuledOut& one : answer.choice.ruled_out)
      consider({one.technique, one.seconds, true, one.by_bound});
  return nearest;
}

std::string predicted_rival(const ChooseAnswer& answer) {
  const auto rival = nearest_rival(answer);
  if (!rival) return "no other technique was considered";
  const double times = rival->seconds / answer.choice.best().time.total();
  const auto technique = name(rival->technique);
  if (rival->ruled_out)
    return fmt::format("{} is ruled out: {} it would take {}{} ({:.3g} s)", technique,
                       rival->by_bound ? "even at best" : "by its closed form", rival->by_bound ? "" : "about ",
                       as_long(times), rival->seconds);
  const char* const doubt = rival->extrapolated ? "its closed form is extrapolated" : "its closed form is less certain";
  if (times < 1)
    return fmt::format("{} is predicted to take {} ({:.3g} s), but is not chosen, because {}", technique,
                       as_long(times), rival->seconds, doubt);
  return fmt::format("{} is next: predicted {:.3g} s, {}{}", technique, rival->seconds, as_long(times),
                     rival->extrapolated ? " (its closed form is extrapolated)" : "");
}

std::string measured_rival(const validate::Analysis& analysis) {
  const validate::Analysed& best = analysis.candidates[*analysis.best];
  const validate::Analysed* next = nullptr;
  for (const validate::Analysed& one : analysis.candidates)
    if (one.seconds && one.candidate.technique != best.candidate.technique &&
        (next == nullptr || *one.seconds < *next->seconds))
      next = &one;
  if (next == nullptr) {
    const bool given_up = std::ranges::any_of(
        analysis.candidates, [](const validate::Analysed& one) { return one.given_up_after.has_value(); });
    return given_up ? "every other technique that was tried took far longer and was given up"
                    : "no other technique was measured";
  }
  return fmt::format("{} is next: measured {:.3g} s, {}", title(next->candidate), *next->seconds,
                     as_long(*next->seconds / *best.seconds));
}

std::string not_examined(const std::vector<Technique>& techniques) {
  std::vector<std::string_view> names;
  for (const Technique technique : techniques) names.push_back(name(technique));
  return fmt::format("; not examined, to save time: {}", names.size() <= most_names
                                                             ? fmt::format("{}", fmt::join(names, ", "))
                                                             : fmt::format("{} techniques", names.size()));
}

}  // namespace

std::string rival_line(const ChooseAnswer& answer) {
  if (answer.analysis && answer.analysis->best) return "rival     " + measured_rival(*answer.analysis);
  std::string line = "rival     " + predicted_rival(answer);
  if (answer.by_sample() && !answer.choice.unexamined.empty()) line += not_examined(answer.choice.unexamined);
  return line;
}

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

/// "d = 0.31 or more", "3000 rays or fewer" or "1 thread".
std::string where(const Tip& tip) {
  if (tip.input == TipInput::threads) return threads_text(static_cast<int>(tip.at));
  if (tip.input == TipInput::rays)
    return fmt::format("{:.0f} rays or {}", three_digits(tip.at), tip.ratio > 1 ? "more" : "fewer");
  return fmt::format("d = {:.3g} or {}", tip.at, tip.ratio > 1 ? "more" : "less");
}

/// " (40 % fewer)", " (4 times as many)": how far from the present value; nothing for threads.
std::string how_far(const Tip& tip) {
  if (tip.input == TipInput::threads) return "";
  const bool rays = tip.input == TipInput::rays;
  if (tip.ratio >= 1.995) return fmt::format(" ({:.3g} times as {})", tip.ratio, rays ? "many" : "large");
  return fmt::format(" ({:.0f} % {})", 100 * std::abs(tip.ratio - 1),
                     tip.ratio > 1 ? (rays ? "more" : "larger") : (rays ? "fewer" : "smaller"));
}

std::string tip_text(const Tip& tip) {
  const auto technique = name(tip.candidate.technique);
  const std::string there = where(tip) + how_far(tip);
  switch (tip.kind) {
    case TipKind::technique:
      return fmt::format("{} is faster with {}", technique, there);
    case TipKind::not_ruled_out:
      return fmt::format("{} is no longer ruled out with {}", technique, there);
    case TipKind::parameters:
      return fmt::format("{} is {:.0f} % faster with {}", title(tip.candidate), 100 * validate::distinguishable, there);
    case TipKind::threads:
      return fmt::format("{} {} faster with {}", threads_text(tip.threads), tip.threads == 1 ? "is" : "are", there);
  }
  return "";
}

/// One text for each technique that is or may be faster elsewhere: "ray-map may be faster with d = 0.1 or less, or 1 thread".
std::vector<std::string> by_technique(const validate::Tips& tips) {
  std::vector<const Tip*> firsts;
  std::vector<std::string> texts;
  for (const Tip& tip : tips.tips) {
    if (tip.kind != TipKind::technique && tip.kind != TipKind::not_ruled_out) continue;
    const auto same = std::ranges::find_if(firsts, [&](const Tip* one) {
      return one->kind == tip.kind && one->candidate.technique == tip.candidate.technique;
    });
    if (same != firsts.end()) {
      texts[static_cast<std::size_t>(same - firsts.begin())] += ", or " + where(tip);
      continue;
    }
    firsts.push_back(&tip);
    texts.push_back(fmt::format("{} {} faster with {}", name(tip.candidate.technique),
                                tip.kind == TipKind::technique ? "is" : "may be", where(tip)));
  }
  return texts;
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
                                       {"technique", name(tip.candidate.technique)},
                                       {"text", tip_text(tip)}});
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

namespace {

std::string no_other_technique(const ChooseAnswer& answer) {
  const auto inputs = without_other_technique(answer.tips);
  const bool all_examined = !answer.by_sample() || answer.choice.unexamined.empty();
  return inputs.empty() ? ""
                        : fmt::format("no other {}technique wins for {}", all_examined ? "" : "examined ",
                                      fmt::join(inputs, ", for "));
}

std::string joined_tips(const ChooseAnswer& answer, std::vector<std::string> texts) {
  if (answer.tips.stopped()) texts.emplace_back("stopped before all inputs were examined");
  return fmt::format("tips      {}{}", answer.analysis && answer.analysis->best ? "as predicted, " : "",
                     fmt::join(texts, "; "));
}

}  // namespace

std::string tips_line(const ChooseAnswer& answer) {
  std::vector<std::string> texts;
  for (const Tip& tip : answer.tips.tips) texts.push_back(tip_text(tip));
  if (std::string none = no_other_technique(answer); !none.empty()) texts.push_back(std::move(none));
  return joined_tips(answer, std::move(texts));
}

std::string short_tips_line(const ChooseAnswer& answer, std::size_t most) {
  std::vector<std::string> texts = by_technique(answer.tips);
  if (texts.empty()) {
    std::string none = no_other_technique(answer);
    texts.push_back(none.empty() ? "no change that was examined brings another technique" : std::move(none));
  } else if (texts.size() > most) {
    const std::size_t more = texts.size() - most;
    texts.resize(most);
    texts.push_back(fmt::format("{} more technique{} with --verbose", more, more == 1 ? "" : "s"));
  }
  return joined_tips(answer, std::move(texts));
}

}  // namespace detp::cli
