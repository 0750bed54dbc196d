#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/whole/whole.hpp"

/// Marks of extrapolated predictions (detp/model/rank/extrapolation.hpp), and the whole wait and memory of a command.
namespace detp::cli {

/// The key "extrapolated" (true or false), and "extrapolated_because" with the reasons.
[[nodiscard]] Json extrapolated_json(const std::vector<std::string>& reasons);

/// The mark of a prediction in text: "!" of an extrapolated closed form that is never chosen, as those of `real` scenes
/// other than of box trees and brute force; "~" of another extrapolated one; else nothing.
[[nodiscard]] std::string_view extrapolation_mark(Technique technique, const std::vector<std::string>& reasons,
                                                  bool real);

/// For text: the reasons why predictions are marked with ~ or !. If a reason applies only to some of the marked techniques,
/// their names follow. Empty if no prediction is extrapolated.
[[nodiscard]] std::string extrapolated_note(std::span<const std::pair<Technique, std::vector<std::string>>> predictions,
                                            bool real);

struct Whole {
  validate::WholeSeconds seconds;
  std::optional<double> peak_bytes;
};

/// `read`, `trace`, `prepare`, `search`, `total`; the total also has the start of the program and writing.
[[nodiscard]] Json whole_json(const validate::WholeSeconds& seconds);

/// "whole     0.41 s: reading 0.12, …; 121 MB", with predictions beside what was measured, as "0.41 s (predicted 0.38)".
[[nodiscard]] std::string whole_line(const std::optional<Whole>& predicted, const std::optional<Whole>& measured);

}  // namespace detp::cli
