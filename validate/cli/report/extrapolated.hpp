#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/validate/cli/text/result.hpp"

/// Marks extrapolated predictions in results (detp/model/rank/extrapolation.hpp).
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

}  // namespace detp::cli
