#pragma once

#include <string>
#include <vector>

#include "detp/sim/effects/observe.hpp"
#include "detp/validate/answer/parts.hpp"
#include "detp/validate/cli/text/result.hpp"
#include "detp/validate/cli/text/screen.hpp"
#include "detp/validate/cli/text/table.hpp"
#include "detp/validate/job/job.hpp"

/// The effects in text.
namespace detp::cli {

using validate::effect_cells;
using validate::effect_columns;
using validate::to_json;

/// "effects   on: finite paths (0.3, differs from 1 by more than 0.05); off: facing, uneven rays (close)": value and
/// threshold of those that are on; whether those that are off are close to their threshold; whether one was switched by hand.
[[nodiscard]] std::string effects_line(const std::vector<sim::EffectReport>& effects);

/// "effects   on: finite paths, occlusion (by hand); 7 off".
[[nodiscard]] std::string short_effects_line(const std::vector<sim::EffectReport>& effects);

/// The table of `detp scene`.
[[nodiscard]] std::string effects_table(const sim::Observed& observed, const std::vector<double>& if_switched,
                                        const Screen& screen);

}  // namespace detp::cli
