#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "detp/validate/choose/choose.hpp"
#include "detp/validate/cli/options/common_options.hpp"
#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/cli/text/screen.hpp"
#include "detp/validate/map/technique_map.hpp"

/// The text of `detp choose`, the parts of it, and its map.
namespace detp::cli {

using validate::ChooseAnswer;
using validate::ChooseRow;

/// What the text has besides the answer.
struct TextDetail {
  bool verbose = false;   ///< all candidates, what was ruled out, the paper's rule, evidence of effects, legends
  bool measured = false;  ///< of an analysis: a short table of the fastest candidate of each technique
};

/// At most 12 lines of 120 columns without details, for scenes whose name fits on a line. An analysis that is shown begins with its result.
[[nodiscard]] std::string to_text(const ChooseAnswer& answer, const Screen& screen, const TextDetail& detail = {});

/// A line of the answer, broken where the screen ends; an empty one is left out.
[[nodiscard]] inline std::string paragraph(const std::string& line, const Screen& screen) {
  return line.empty() ? "" : wrapped(line, screen.text_width(), 10);
}

[[nodiscard]] inline std::vector<std::string_view> names_of(const std::vector<Technique>& techniques) {
  std::vector<std::string_view> names;
  for (const Technique technique : techniques) names.push_back(name(technique));
  return names;
}

/// The line "choice", in bold.
[[nodiscard]] std::string choice_text(const std::string& what, const Screen& screen);

/// The lines "choice", "regret" and "predicted": the candidate with the shortest measured time, whether it was the predicted
/// choice, and how well its seconds were predicted. After a stop, also how many candidates were tried.
[[nodiscard]] std::string measured_lines(const ChooseAnswer& answer, const Screen& screen);

/// The line "gain": what testing all pairs would take, as predicted. Empty if nothing was measured.
[[nodiscard]] std::string gain_line(const ChooseAnswer& answer);

/// The lines "missed": the errors of the predictions of the predicted choice and of the fastest candidate.
[[nodiscard]] std::string missed_lines(const ChooseAnswer& answer, const Screen& screen);

/// The line "rival": the technique next to the choice, and how much slower it is or why it is ruled out. Then the
/// techniques that were not examined. After a measurement, the fastest candidate of another technique.
[[nodiscard]] std::string rival_line(const ChooseAnswer& answer);

/// The line "tips": changes of one input that change the choice, and where no other technique wins.
[[nodiscard]] std::string tips_line(const ChooseAnswer& answer);

/// The line "tips", shorter: the techniques that are or may be faster elsewhere, at most `most` of them; if there are none, where no
/// other technique wins.
[[nodiscard]] std::string short_tips_line(const ChooseAnswer& answer, std::size_t most);

/// The table of candidates, after an empty line.
[[nodiscard]] std::string candidate_table(const ChooseAnswer& answer, const Screen& screen);

/// After an analysis: the fastest measured candidate of each technique and the predicted choice, after an empty line. Then
/// the techniques that were not timed.
[[nodiscard]] std::string measured_table(const ChooseAnswer& answer, const Screen& screen);

/// The notes below the table: what it extrapolates, and what its columns mean.
[[nodiscard]] std::string candidate_notes(const ChooseAnswer& answer, const Screen& screen);

/// `choose --map`: the answer. If --output names a file *.svg, writes the picture there, and the result goes to stdout. Throws as
/// validate::answer.
[[nodiscard]] Result run_choose_map(const validate::MapRequest& request, const CommonOptions& common, bool verbose,
                                    const std::stop_token& stop);

}  // namespace detp::cli
