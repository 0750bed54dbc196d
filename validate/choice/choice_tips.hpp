#pragma once

#include "allowed_ranking.hpp"
#include "pilot.hpp"
#include "tips.hpp"

/// The tips of a choice.
namespace detp::validate {

/// Tips of a choice by a pilot, for radii and numbers of rays up to four times larger or smaller: choose_again with each
/// of these. `options` and `problem` must be those of the pilot, and its discs not built. `workload` is that of the
/// problem; its disc radius is the one that is changed.
///
/// Cost       1.3 to 13 million instructions for 2000 to 86 000 discs and 300 to 3 000 000 rays, 3.0 in @tree with 100 000
///            photon paths (valgrind --tool=callgrind), a tenth to a half of those of the pilot
[[nodiscard]] Tips tips_of(const PilotChoice& pilot, const sim::Problem& problem, const Workload& workload,
                           const Valid<CostTable>& costs, const PilotOptions& options);

/// Tips of a choice by closed forms, for radii and numbers of rays up to 16 times larger or smaller: allowed_ranking with
/// each of these. `choice` is the first of the present ranking.
///
/// Cost       55 to 236 million instructions in four examples (valgrind --tool=callgrind)
[[nodiscard]] Tips tips_of(const Candidate& choice, const Workload& workload, const Valid<CostTable>& costs,
                           std::span<const Technique> disabled, const model::SearchLimits& limits);

}  // namespace detp::validate
