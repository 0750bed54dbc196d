#pragma once

#include <span>
#include <vector>

#include "choice.hpp"
#include "detp/model/rank/choose.hpp"

/// Choices by closed forms, and the workloads for these.
namespace detp::validate {

/// Whether the question has a workload, or discs and rays on which it can be measured.
[[nodiscard]] bool can_measure(const Question& question);

/// The question's workload with that number of rays: measured on its rays and discs, unless it has one. For one search that is too short for
/// evidence to pay (sim::evidence_can_pay), the workload with the meanings of the input alone. Throws as sim::set_rays and sim::observe.
[[nodiscard]] Workload evidence(const Question& question, double rays);

/// model::rank without the disabled techniques, the choice first (put_choice_first). model::rank does not tune a technique
/// that is slower than another one; where that one is disabled, this function tunes it. Empty if all are disabled. Throws as
/// model::rank.
[[nodiscard]] std::vector<Prediction> allowed_ranking(const Valid<Workload>& workload, const Valid<CostTable>& costs,
                                                      std::span<const Technique> disabled,
                                                      const model::SearchLimits& limits = {});

}  // namespace detp::validate
