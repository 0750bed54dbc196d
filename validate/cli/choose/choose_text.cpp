#include "choose_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "detp/validate/cli/report/effects_report.hpp"
#include "detp/validate/cli/report/prediction_report.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/words.hpp"

namespace detp::cli {
namespace {

constexpr std::size_t most_lines = 11;    // a stopped answer has one more
constexpr std::size_t usual_width = 120;  // of which they are lines

/// "0.0172 ± 0.009 s", and what the error does not cover.
std::string predicted_seconds(const ChooseAnswer& answer) {
  const double error = answer.error();
  const char* const note = answer.by_sample() ? ""
                           : error > 0        ? " (error of unit costs; that of its closed form is not known)"
                                              : " (its error is not known)";
  return fmt::format("{:.3g}{} s{}", answer.choice.best().seconds(), error > 0 ? fmt::format(" ± {:.1g}", error) : "",
                     note);
}

/// Other parameters of the chosen technique whose times cannot be told apart from the choice's: "; 5 other …".
std::string close_shapes(const ChooseAnswer& answer) {
  const std::vector<ChooseRow> rows = rows_of(answer);
  const auto close = std::count_if(rows.begin() + 1, rows.end(), [&](const ChooseRow& row) {
    return row.candidate.technique == rows.front().candidate.technique && row.could_win;
  });
  return close == 0 ? ""
                    : fmt::format("; {} other {} of it {} within {:.0f} %", close, close == 1 ? "shape" : "shapes",
                                  close == 1 ? "is" : "are", 100 * validate::distinguishable);
}

std::string extrapolated(const std::vector<std::string>& reasons) {
  if (reasons.empty()) return "";
  const std::size_t others = reasons.size() - 1;
  return fmt::format("; extrapolated: {}{}", reasons.front(),
                     others == 0   ? ""
                     : others == 1 ? ", and 1 more reason"
                                   : fmt::format(", and {} more reasons", others));
}

std::string predicted_choice(const ChooseAnswer& answer) {
  const auto& choice = answer.choice.best();
  return fmt::format("{}, {}: predicted {}{}{}", title(choice.candidate), threads_text(choice.threads),
                     predicted_seconds(answer), answer.analysis ? "" : close_shapes(answer),
                     extrapolated(choice.extrapolated));
}

std::string ruled_out_line(const validate::Choice& choice) {
  std::string list;
  for (const validate::RuledOut& one : choice.ruled_out)
    list += fmt::format("{}{} ({}{:.2g} s)", list.empty() ? "" : ", ", name(one.technique),
                        one.by_bound ? "at least " : "", one.seconds);
  return "ruled out " + (list.empty() ? "none" : list);
}

std::string not_examined_line(const validate::Choice& choice) {
  return fmt::format("unknown   {}: to find out would take longer than it could save",
                     fmt::join(names_of(choice.unexamined), ", "));
}

std::string how_chosen(const ChooseAnswer& answer) {
  const std::string run =
      answer.rigor == Rigor::measure ? fmt::format("runs of {} candidates, after ", answer.analysis->tried) : "";
  if (!answer.by_sample()) return run + "closed forms alone";
  if (!answer.choice.discs) return run + "no pilot: brute force is faster than sorting the discs";
  const std::string sample = answer.rigor == Rigor::structural
                                 ? fmt::format("{} {} of the field, not those of the run", answer.choice.sampled_rays,
                                               answer.workload.path_length > 0 ? "segments" : "lines")
                                 : fmt::format("{} of {:.6g} rays", answer.choice.sampled_rays, answer.workload.rays);
  return fmt::format("{}a pilot of {}{}", run, sample, run.empty() ? "; the discs that it sorted are kept" : "");
}

std::string planning_line(const ChooseAnswer& answer) {
  const double seconds = answer.choosing_seconds;
  const double share = seconds / answer.choice.best().seconds();
  return fmt::format(
      "planning  {} ({} the predicted run): {}",
      seconds < 1 ? fmt::format("{:.{}g} ms", 1e3 * seconds, seconds < 0.1 ? 2 : 3) : fmt::format("{:.3g} s", seconds),
      share < 1 ? fmt::format("{:.2g} % of", 100 * share) : number_of_times(share), how_chosen(answer));
}

std::string costs_line(const ChooseAnswer& answer, bool verbose) {
  const bool plain = answer.costs.engine == Engine::plain;
  return fmt::format("costs     {}{}", answer.costs_origin,
                     verbose || plain ? fmt::format("; engine {}", name(answer.costs.engine)) : "");
}

/// Scene and rays.
std::string title_lines(const ChooseAnswer& answer, const Screen& screen) {
  if (answer.job) return paragraph(describe(*answer.job), screen);
  const Workload& workload = answer.workload;
  return paragraph(
      fmt::format("workload  {:.6g} rays, {:.6g} samples, discs of radius d = {:.4g}, r0 = {:.4g}, D = {:.2f}\n",
                  workload.rays, workload.samples, workload.disc_radius, workload.sphere_radius, workload.dimension),
      screen);
}

std::string bytes_text(double bytes) {
  return bytes >= 1e9 ? fmt::format("{:.3g} GB", bytes / 1e9) : fmt::format("{:.3g} MB", bytes / 1e6);
}

std::string ranks_line(const validate::RanksAnswer& answer) {
  return fmt::format(
      "ranks     {:.9g} processes share the {}: {:.3g} ± {:.1g} s with making the rays (one process {:.3g} s); {} on "
      "rank 0{}, which receives {}",
      answer.ranks, answer.by_rays ? "rays" : "discs", answer.best().total(), answer.error, answer.alone,
      bytes_text(answer.best().memory),
      answer.fits ? "" : fmt::format(", more than the {} that it may have", bytes_text(answer.memory_limit)),
      bytes_text(answer.best().traffic));
}

std::string choice_lines(const ChooseAnswer& answer, const Screen& screen) {
  const bool measured = answer.fastest() != nullptr;
  return (measured ? "" : choice_text(predicted_choice(answer), screen)) +
         (answer.analysis ? measured_lines(answer, screen) : "") +
         (answer.ranks ? paragraph(ranks_line(*answer.ranks), screen) : "");
}

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

std::string hint(const Screen& screen) {
  return legend(screen,
                "--verbose shows all candidates, what was ruled out, the paper's rule, evidence of effects, symbols");
}

/// What the short text has if it fits.
struct Detail {
  std::size_t tips = 0;  ///< at most
  bool whole = true;
  bool spaced = true;
};

std::string with_detail(const ChooseAnswer& answer, const Screen& screen, const Detail& detail) {
  return title_lines(answer, screen) + paragraph(short_effects_line(answer.effects), screen) +
         (detail.spaced ? "\n" : "") + choice_lines(answer, screen) + paragraph(rival_line(answer), screen) +
         paragraph(short_tips_line(answer, detail.tips), screen) +
         (detail.whole ? paragraph(whole_line(answer.whole, {}), screen) : "") +
         paragraph(planning_line(answer), screen) + paragraph(costs_line(answer, false), screen);
}

/// With as many tips as fit, the whole wait, the hint and the empty line if they fit.
std::string short_text(const ChooseAnswer& answer, const Screen& screen) {
  const auto lines = [&](const Detail& detail) {
    return lines_of(with_detail(answer, {.width = usual_width}, detail));
  };
  Detail detail{answer.tips.tips.size() + 1};
  while (detail.tips > 1 && lines(detail) > most_lines) --detail.tips;
  detail.whole = lines(detail) <= most_lines + 1;
  detail.spaced = lines(detail) <= most_lines;
  return with_detail(answer, screen, detail) + (lines(detail) < most_lines ? hint(screen) : "");
}

std::string analysis_text(const ChooseAnswer& answer, const Screen& screen) {
  return choice_lines(answer, screen) + paragraph(gain_line(answer), screen) + measured_table(answer, screen) + "\n" +
         title_lines(answer, screen) + paragraph(short_effects_line(answer.effects), screen) +
         paragraph(planning_line(answer), screen) + paragraph(costs_line(answer, false), screen) + hint(screen);
}

std::string verbose_text(const ChooseAnswer& answer, const Screen& screen) {
  std::string text;
  const auto add = [&](const std::string& line) { text += paragraph(line, screen); };
  if (answer.analysis) {
    text += choice_lines(answer, screen) + missed_lines(answer, screen) + paragraph(gain_line(answer), screen) + "\n";
  }
  text += title_lines(answer, screen);
  add(effects_line(answer.effects));
  text += candidate_table(answer, screen) + candidate_notes(answer, screen) + "\n";
  if (!answer.analysis) text += choice_lines(answer, screen);
  add(rival_line(answer));
  if (answer.by_sample()) add(ruled_out_line(answer.choice));
  if (answer.by_sample() && !answer.choice.unexamined.empty()) add(not_examined_line(answer.choice));
  add(tips_line(answer));
  add(fmt::format("paper     its rule takes {}: predicted {:.3g} s, {}", title(answer.paper.candidate),
                  answer.paper.seconds(),
                  as_long(answer.paper.seconds() / answer.choice.best().seconds(), "the predicted choice")));
  add(whole_line(answer.whole, {}));
  add(planning_line(answer));
  add(fmt::format("rigor     {}", name(answer.rigor)));
  add(costs_line(answer, true));
  return text;
}

}  // namespace

std::string to_text(const ChooseAnswer& answer, const Screen& screen, const TextDetail& detail) {
  if (detail.verbose) return verbose_text(answer, screen);
  return detail.measured && answer.analysis ? analysis_text(answer, screen) : short_text(answer, screen);
}

}  // namespace detp::cli
