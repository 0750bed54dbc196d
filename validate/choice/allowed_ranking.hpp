#pragma once

#include <span>
#include <vector>

#include "detp/model/rank/choose.hpp"

namespace detp::validate {

/// How many times as long as predicted a search may take, in scenes for which its closed form was not made.
inline constexpr double closed_form_doubt = 2;

/// How much a closed form is doubted: 1 for brute force and box trees, which were compared with real scenes, and for closed
/// forms that are not extrapolated (model::Ranked::extrapolated). closed_form_doubt where only numbers are out of range. Infinite in
/// scenes of another kind (unless model::is_counted_scene), where tests were off by up to 17 times.
[[nodiscard]] double doubt_of(const Valid<Workload>& workload, const model::Ranked& one);

/// model::rank without the disabled techniques, with the choice first: the candidate that is fastest even if each takes
/// doubt_of times as long as predicted; the fastest if all doubts are infinite. model::rank does not tune a technique that is slower than another one;
/// where that one is disabled, this function tunes it. Empty if all are disabled. Throws as model::rank.
[[nodiscard]] std::vector<model::Ranked> allowed_ranking(const Valid<Workload>& workload, const Valid<CostTable>& costs,
                                                         std::span<const Technique> disabled,
                                                         const model::SearchLimits& limits = {});

}  // namespace detp::validate
