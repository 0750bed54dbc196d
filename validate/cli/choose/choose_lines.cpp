#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "choose_text.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/words.hpp"

/// The lines of what was measured, of the rival and of tips.
namespace detp::cli {
namespace {

using validate::Analysed;
using validate::Tip;
using validate::TipInput;
using validate::TipKind;

/// "12 % too high: counts 2 % too low, unit costs 14 % too high": seconds and the two causes of their error.
std::string causes(const validate::PredictionError& error) {
  return fmt::format("{}: counts {}, unit costs {}", how_far_off(error.seconds), how_far_off(error.counts),
                     how_far_off(error.unit_costs));
}

/// The line "predicted": how well the seconds of the predicted choice were predicted. Its interval is of two standard
/// errors: times and over (1 + the relative error)².
std::string predicted_line(const ChooseAnswer& answer) {
  const ChooseRow row = rows_of(answer).front();
  if (!row.missed) return "";
  const double seconds = row.predicted->time.again();
  std::string text =
      fmt::format("predicted {:.2g} s{}", seconds, answer.analysis->best == 0U ? "" : " for that choice");
  const double error = row.error() / row.predicted->seconds();
  if (!(error > 0)) return text + ", " + causes(*row.missed);
  const double factor = (1 + error) * (1 + error);
  const bool inside = *row.run->seconds > seconds / factor && *row.run->seconds < seconds * factor;
  return text + fmt::format(" ({:.2g} to {:.2g}): measured {}, {}", seconds / factor, seconds * factor,
                            inside ? "inside" : "outside", causes(*row.missed));
}

std::string missed_line(const ChooseRow& row) {
  const std::string tried = title(row.candidate);
  if (row.predicted == nullptr) return fmt::format("missed    {} has no closed form: it was not predicted", tried);
  if (!row.missed) return "";
  return fmt::format(
      "missed    {}: predicted seconds {}; the count that matters most: {}, {}", tried, causes(*row.missed),
      row.missed->worst,
      std::isfinite(row.missed->worst_ratio) ? how_far_off(row.missed->worst_ratio) : "predicted, but never counted");
}

/// 0.123 as "12".
std::string percent_digits(double share) {
  return share < 0.095 ? fmt::format("{:.1g}", 100 * share) : fmt::format("{:.0f}", 100 * share);
}

/// The line "regret": whether the predicted choice was the right one.
std::string regret_line(const validate::Analysis& analysis) {
  const Analysed& predicted = analysis.candidates.front();
  if (*analysis.best == 0) return "regret    0 %: the predicted choice was right";
  if (!analysis.regret) return "";
  const double regret = *analysis.regret;
  const double error = analysis.regret_error;
  return fmt::format("regret    {}{} %: {}, the predicted choice, takes {:.3g} s{}", percent_digits(regret),
                     error > 0 ? " ± " + percent_digits(error) : "", title(predicted.candidate), *predicted.seconds,
                     regret <= error || regret < 0.01 ? ": as fast, within the noise" : "");
}

}  // namespace

std::string choice_text(const std::string& what, const Screen& screen) {
  std::string lines = paragraph("choice    " + what, screen);
  lines.pop_back();
  return styled(screen, Style::strong, lines) + "\n";
}

std::string measured_lines(const ChooseAnswer& answer, const Screen& screen) {
  const validate::Analysis& analysis = *answer.analysis;
  std::string text;
  if (const Analysed* const best = answer.fastest()) {
    text += choice_text(fmt::format("{}, {}: measured {:.3g}{} s, the fastest of {} tried", title(best->candidate),
                                    threads_text(best->threads), *best->seconds,
                                    best->spread > 0 ? fmt::format(" ± {:.1g}", best->spread) : "", analysis.tried),
                        screen) +
            paragraph(regret_line(analysis), screen) + paragraph(predicted_line(answer), screen);
  }
  if (analysis.stopped)
    text += paragraph(fmt::format("tried     {} of {} candidates before the stop: the others may be faster",
                                  analysis.tried, analysis.candidates.size()),
                      screen);
  return text;
}

std::string gain_line(const ChooseAnswer& answer) {
  const Analysed* const best = answer.fastest();
  if (best == nullptr) return "";
  // The counts of brute force are exact. Those of the paper's rule are extrapolated in a scene, up to ten times too high.
  return fmt::format("gain      testing every ray with every disc would take {:.2g} s (predicted), {}",
                     answer.brute_force, as_long(answer.brute_force / *best->seconds));
}

std::string missed_lines(const ChooseAnswer& answer, const Screen& screen) {
  std::string text;
  if (answer.fastest() == nullptr) return text;
  for (const ChooseRow& row : explained_rows(answer)) text += paragraph(missed_line(row), screen);
  return text;
}

namespace {

/// A technique other than the choice.
struct Rival {
  Technique technique;
  double seconds;
  const validate::RuledOut* ruled_out = nullptr;
  bool extrapolated = false;  ///< its closed form
};

std::optional<Rival> nearest_rival(const ChooseAnswer& answer) {
  std::optional<Rival> nearest;
  const auto consider = [&](const Rival& one) {
    if (one.technique != answer.choice.best().candidate.technique && (!nearest || one.seconds < nearest->seconds))
      nearest = one;
  };
  for (const Prediction& one : answer.choice.candidates)
    consider({one.candidate.technique, one.seconds(), nullptr, !one.extrapolated.empty()});
  for (const validate::RuledOut& one : answer.choice.ruled_out) consider({one.technique, one.seconds, &one});
  return nearest;
}

std::string predicted_rival(const ChooseAnswer& answer) {
  const auto rival = nearest_rival(answer);
  if (!rival) return "no other technique was considered";
  const double times = rival->seconds / answer.choice.best().seconds();
  const auto technique = name(rival->technique);
  if (rival->ruled_out != nullptr)
    return fmt::format("{} is ruled out: {} it would take {}{} ({:.3g} s)", technique,
                       rival->ruled_out->by_bound ? "even at best" : "by its closed form",
                       rival->ruled_out->by_bound ? "" : "about ", as_long(times), rival->seconds);
  const char* const doubt = rival->extrapolated ? "its closed form is extrapolated" : "its closed form is less certain";
  if (times < 1)
    return fmt::format("{} is predicted to take {} ({:.3g} s), but is not chosen, because {}", technique,
                       as_long(times), rival->seconds, doubt);
  return fmt::format("{} is next: predicted {:.3g} s, {}{}", technique, rival->seconds, as_long(times),
                     rival->extrapolated ? " (its closed form is extrapolated)" : "");
}

std::string measured_rival(const validate::Analysis& analysis) {
  const Analysed& best = analysis.candidates[*analysis.best];
  const Analysed* next = nullptr;
  for (const Analysed& one : analysis.candidates)
    if (one.seconds && one.candidate.technique != best.candidate.technique &&
        (next == nullptr || *one.seconds < *next->seconds))
      next = &one;
  if (next == nullptr) {
    const bool given_up =
        std::ranges::any_of(analysis.candidates, [](const Analysed& one) { return one.given_up_after.has_value(); });
    return given_up ? "every other technique that was tried took far longer and was given up"
                    : "no other technique was measured";
  }
  return fmt::format("{} is next: measured {:.3g} s, {}", title(next->candidate), *next->seconds,
                     as_long(*next->seconds / *best.seconds));
}

std::string not_examined(const std::vector<Technique>& techniques) {
  constexpr std::size_t most_names = 3;
  return "; not examined, to save time: " + (techniques.size() <= most_names
                                                 ? fmt::format("{}", fmt::join(names_of(techniques), ", "))
                                                 : fmt::format("{} techniques", techniques.size()));
}

}  // namespace

std::string rival_line(const ChooseAnswer& answer) {
  if (answer.fastest() != nullptr) return "rival     " + measured_rival(*answer.analysis);
  std::string line = "rival     " + predicted_rival(answer);
  if (answer.by_sample() && !answer.choice.unexamined.empty()) line += not_examined(answer.choice.unexamined);
  return line;
}

namespace {

bool is_of_technique(const Tip& tip) { return tip.kind == TipKind::technique || tip.kind == TipKind::not_ruled_out; }

/// One text for each technique that is or may be faster elsewhere: "ray-map may be faster with d = 0.1 or less, or 1 thread".
std::vector<std::string> by_technique(const validate::Tips& tips) {
  std::vector<const Tip*> firsts;
  std::vector<std::string> texts;
  for (const Tip& tip : tips.tips) {
    if (!is_of_technique(tip)) continue;
    const auto same = std::ranges::find_if(firsts, [&](const Tip* one) {
      return one->kind == tip.kind && one->candidate.technique == tip.candidate.technique;
    });
    if (same != firsts.end()) {
      texts[static_cast<std::size_t>(same - firsts.begin())] += ", or " + place_of(tip);
      continue;
    }
    firsts.push_back(&tip);
    texts.push_back(fmt::format("{} {} faster with {}", name(tip.candidate.technique),
                                tip.kind == TipKind::technique ? "is" : "may be", place_of(tip)));
  }
  return texts;
}

/// Where no other technique wins: "no other technique wins for d from 0.25 to 4, for 1 to 2 threads"; empty if there is one in all inputs.
std::string no_other_technique(const ChooseAnswer& answer) {
  std::vector<std::string> inputs;
  for (const TipInput input : validate::tip_inputs) {
    const validate::TipRange& range = answer.tips.range(input);
    const bool changes = std::ranges::any_of(
        answer.tips.tips, [&](const Tip& tip) { return tip.input == input && is_of_technique(tip); });
    if (!changes && range.least != range.most) inputs.push_back(text_of(input, range));
  }
  const bool all_examined = !answer.by_sample() || answer.choice.unexamined.empty();
  return inputs.empty() ? ""
                        : fmt::format("no other {}technique wins for {}", all_examined ? "" : "examined ",
                                      fmt::join(inputs, ", for "));
}

std::string joined_tips(const ChooseAnswer& answer, std::vector<std::string> texts) {
  if (answer.tips.stopped()) texts.emplace_back("stopped before all inputs were examined");
  return fmt::format("tips      {}{}", answer.fastest() != nullptr ? "as predicted, " : "", fmt::join(texts, "; "));
}

}  // namespace

std::string tips_line(const ChooseAnswer& answer) {
  std::vector<std::string> texts;
  for (const Tip& tip : answer.tips.tips) texts.push_back(text_of(tip));
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
