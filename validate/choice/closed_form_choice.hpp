#pragma once

#include <span>
#include <vector>

#include "detp/model/rank/choose.hpp"

namespace detp::validate {

/// model::rank without the disabled techniques, the choice first (put_choice_first). model::rank does not tune a technique
/// that is slower than another one; where that one is disabled, this function tunes it. Empty if all are disabled. Throws as
/// model::rank.
[[nodiscard]] std::vector<Prediction> allowed_ranking(const Valid<Workload>& workload, const Valid<CostTable>& costs,
                                                      std::span<const Technique> disabled,
                                                      const model::SearchLimits& limits = {});

}  // namespace detp::validate
