#pragma once

#include <span>
#include <vector>

#include "detp/model/rank/choose.hpp"

namespace detp::validate {

/// How many times as long as predicted a search may take, in scenes for which its closed form was not made.
inline constexpr double closed_form_doubt = 2;

/// model::rank without the disabled techniques, with the choice first: the candidate that is fastest even if extrapolated
/// closed forms (model::Ranked::extrapolated) are closed_form_doubt times too short, except those of brute force and of box
/// trees, which were compared with real scenes. model::rank does not tune a technique that is slower than another one;
/// where that one is disabled, this function tunes it. Empty if all are disabled. Throws as model::rank.
[[nodiscard]] std::vector<model::Ranked> allowed_ranking(const Valid<Workload>& workload, const Valid<CostTable>& costs,
                                                         std::span<const Technique> disabled,
                                                         const model::SearchLimits& limits = {});

}  // namespace detp::validate
