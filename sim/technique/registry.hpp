#pragma once

#include "detp/sim/search/index.hpp"

/// The function that prepares the search of each technique. Parameters have been checked and belong to the technique.
namespace detp::sim {

using Prepare = std::unique_ptr<Index>(const Problem& problem, const Parameters& parameters, const RunOptions& options);

struct TechniqueSearch {
  Technique technique;
  Prepare* prepare;
};

[[nodiscard]] const TechniqueSearch& search_of(Technique technique);

/// Builds the index of a candidate over a problem's discs. The problem needs no rays yet. The rays that are searched
/// later must start at most Problem::farthest from the centre of S₀. Throws as run does; Stopped if a stop was
/// requested.
[[nodiscard]] std::unique_ptr<Index> prepare(const Problem& problem, const Valid<Candidate>& candidate,
                                             const RunOptions& options);

}  // namespace detp::sim
