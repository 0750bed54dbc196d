#pragma once

#include <span>
#include <string>
#include <vector>

#include "detp/model/rank/choose.hpp"

namespace detp::validate {

/// How many times as long as predicted a search may take, in scenes for which its closed form was not made.
inline constexpr double closed_form_doubt = 2;

/// Infinite for an extrapolated closed form (model::Ranked::extrapolated), whose tests were off by up to 17 times; 1 for
/// brute force and box trees, which were compared with real scenes, and for other closed forms.
[[nodiscard]] double doubt_of(Technique technique, std::span<const std::string> extrapolated);

/// model::rank without the disabled techniques, with the choice first: the fastest candidate whose closed form is not
/// doubted (doubt_of), or the fastest of all if each is. model::rank does not tune a technique that is slower than another one;
/// where that one is disabled, this function tunes it. Empty if all are disabled. Throws as model::rank.
[[nodiscard]] std::vector<model::Ranked> allowed_ranking(const Valid<Workload>& workload, const Valid<CostTable>& costs,
                                                         std::span<const Technique> disabled,
                                                         const model::SearchLimits& limits = {});

}  // namespace detp::validate
