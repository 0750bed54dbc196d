#pragma once

#include "choice.hpp"

namespace detp::validate {

/// Whether the question has a workload, or discs and rays on which it can be measured.
[[nodiscard]] bool can_measure(const Question& question);

/// The question's workload with that number of rays: measured on its rays and discs, unless it has one. For one search that is too short for
/// evidence to pay (sim::evidence_can_pay), the workload with the meanings of the input alone. Throws as sim::set_rays and sim::observe.
[[nodiscard]] Workload evidence(const Question& question, double rays);

}  // namespace detp::validate
