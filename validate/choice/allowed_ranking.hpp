#pragma once

#include <span>
#include <vector>

#include "detp/model/rank/choose.hpp"

namespace detp::validate {

/// How many times as long as predicted a search may take, in scenes for which its closed form was not made.
inline constexpr double closed_form_doubt = 2;

/// closed_form_doubt for an extrapolated closed form (model::Ranked::extrapolated), except those of brute force and of box
/// trees, which were compared with real scenes; otherwise 1.
[[nodiscard]] double doubt_of(const model::Ranked& one);

/// model::rank without the disabled techniques, with the choice first: the candidate that is fastest even if each takes
/// doubt_of times as long as predicted. model::rank does not tune a technique that is slower than another one;
/// where that one is disabled, this function tunes it. Empty if all are disabled. Throws as model::rank.
[[nodiscard]] std::vector<model::Ranked> allowed_ranking(const Valid<Workload>& workload, const Valid<CostTable>& costs,
                                                         std::span<const Technique> disabled,
                                                         const model::SearchLimits& limits = {});

}  // namespace detp::validate
