#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/validate/answer/parts.hpp"
#include "detp/validate/cli/text/result.hpp"

/// Marks of extrapolated predictions (detp/model/rank/predict.hpp), and the whole wait and memory of a command.
namespace detp::cli {

using validate::extrapolated_json;
using validate::Whole;
using validate::whole_json;

/// The mark of a prediction in text: "!" of an extrapolated closed form that is never chosen, as those of `real` scenes
/// other than of box trees and brute force; "~" of another extrapolated one; else nothing.
[[nodiscard]] std::string_view extrapolation_mark(Technique technique, const std::vector<std::string>& reasons,
                                                  bool real);

/// For text: the reasons why predictions are marked with ~ or !. If a reason applies only to some of the marked techniques,
/// their names follow. Empty if no prediction is extrapolated.
[[nodiscard]] std::string extrapolated_note(std::span<const std::pair<Technique, std::vector<std::string>>> predictions,
                                            bool real);

/// "whole     0.41 s: reading 0.12, …; 121 MB", with predictions beside what was measured, as "0.41 s (predicted 0.38)".
[[nodiscard]] std::string whole_line(const std::optional<Whole>& predicted, const std::optional<Whole>& measured);

}  // namespace detp::cli
