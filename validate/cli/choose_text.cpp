#include <fmt/format.h>

#include <optional>
#include <utility>

#include "choose_report.hpp"
#include "choose_table.hpp"
#include "choose_tips.hpp"
#include "effects_report.hpp"
#include "measured_report.hpp"
#include "workload_options.hpp"

namespace detp::cli {
namespace {

/// The least predicted time of a technique other than the choice; nothing if there is none.
std::optional<std::pair<Technique, double>> next_technique(const ChooseAnswer& answer) {
  const Technique chosen = answer.choice.best().candidate.technique;
  std::optional<std::pair<Technique, double>> next;
  const auto consider = [&](Technique technique, double seconds) {
    if (technique != chosen && (!next || seconds < next->second)) next = {technique, seconds};
  };
  for (const Prediction& ranked : answer.choice.candidates) consider(ranked.candidate.technique, ranked.time.total());
  if (answer.by_sample())
    for (const validate::RuledOut& one : answer.choice.ruled_out) consider(one.technique, one.seconds);
  return next;
}

std::string margin(const ChooseAnswer& answer) {
  const double seconds = answer.choice.best().time.total();
  const double error = answer.by_sample() ? answer.choice.best().error : 0;
  const std::string predicted =
      fmt::format("predicted {:.3g}{} s", seconds, error > 0 ? fmt::format(" ± {:.1g}", error) : "");
  const auto next = next_technique(answer);
  if (!next) return predicted + ", no other technique";
  const double times = next->second / seconds;
  if (times < 1)
    return fmt::format("{}; {} may be faster: predicted {:.3g} s", predicted, name(next->first), next->second);
  return answer.by_sample() ? fmt::format("{}, at least {:.2f} times faster than any other technique{}", predicted,
                                          times, answer.choice.unexamined.empty() ? "" : " that was examined")
                            : fmt::format("{}, {:.2f} times faster than {}", predicted, times, name(next->first));
}

std::string ruled_out_line(const validate::Choice& choice) {
  std::string list;
  for (const validate::RuledOut& one : choice.ruled_out)
    list += fmt::format("{}{} ({}{:.2g} s)", list.empty() ? "" : ", ", name(one.technique),
                        one.by_bound ? "at least " : "", one.seconds);
  return "ruled out " + (list.empty() ? "none" : list);
}

std::string not_examined_line(const validate::Choice& choice) {
  std::string list;
  for (const Technique technique : choice.unexamined) list += (list.empty() ? "" : ", ") + std::string(name(technique));
  return "unknown   " + list + ": to find out would take longer than it could save";
}

std::string how_chosen(const ChooseAnswer& answer) {
  const std::string run =
      answer.rigor == Rigor::measure ? fmt::format("{} candidates run; before that, ", answer.analysis->tried) : "";
  if (!answer.by_sample()) return run + "closed forms alone";
  if (!answer.choice.discs) return run + "no pilot, because sorting the discs would take longer than brute force";
  const std::string sample = answer.rigor == Rigor::structural
                                 ? fmt::format("{} {} of the field, not those of the run", answer.choice.sampled_rays,
                                               answer.workload.path_length > 0 ? "segments" : "lines")
                                 : fmt::format("{} of {:.6g} rays", answer.choice.sampled_rays, answer.workload.rays);
  return fmt::format("{}{}, through parts of the tree of boxes; the discs that it sorted are kept", run, sample);
}

}  // namespace

std::string to_text(const ChooseAnswer& answer, const Screen& screen) {
  std::string text = wrapped(answer.title, screen.text_width(), 10);
  const auto add = [&](const std::string& line) { text += wrapped(line, screen.text_width(), 10); };
  add(effects_line(answer.effects));
  text += candidate_table(answer, screen) + candidate_notes(answer, screen) + "\n";
  const double fastest = answer.choice.best().time.total();
  if (!answer.analysis || !answer.analysis->best)
    text += choice_text(fmt::format("{}, {}: {}", title(answer.choice.best().candidate),
                                    threads_text(answer.choice.best().threads), margin(answer)),
                        screen);
  if (answer.analysis) text += measured_lines(answer, screen);
  if (answer.by_sample()) add(ruled_out_line(answer.choice));
  if (answer.by_sample() && !answer.choice.unexamined.empty()) add(not_examined_line(answer.choice));
  add(tips_line(answer));
  add(fmt::format("paper     its rule takes {}: predicted {:.3g} s, {:.3g} times as long as the predicted choice",
                  title(answer.paper.candidate), answer.paper.time.total(), answer.paper.time.total() / fastest));
  const double share = answer.choosing_seconds / fastest;
  add(fmt::format("planning  {:.2g} ms ({} the predicted run), rigor {}: {}", 1e3 * answer.choosing_seconds,
                  share < 1 ? fmt::format("{:.2g} % of", 100 * share) : fmt::format("{:.3g} times", share),
                  name(answer.rigor), how_chosen(answer)));
  add(fmt::format("costs     {}; engine {}", answer.costs_origin, name(answer.costs.engine)));
  return text;
}

}  // namespace detp::cli
