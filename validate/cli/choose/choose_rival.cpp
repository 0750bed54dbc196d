#include "choose_rival.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "choose_rows.hpp"
#include "plain_ratio.hpp"

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

}  // namespace detp::cli
