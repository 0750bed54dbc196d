#pragma once

#include "detp/sim/search/index.hpp"
#include "detp/sim/search/outcome.hpp"
#include "detp/sim/search/problem.hpp"

/// Runs any technique: finds which rays cross which discs. All exact techniques give the same result.
namespace detp::sim {

/// Runs one technique: prepares its index, and searches the index once. Throws std::invalid_argument for a problem that
/// make_problem did not make, for parameters that are out of range or belong to another technique, for a number of
/// threads out of range and for totals of other discs; std::length_error, naming the bytes, if an index would not fit
/// in memory. Does not throw Stopped: if a stop was requested, the outcome has `stopped` set and is partial.
[[nodiscard]] Outcome run(const Problem& problem, const Valid<Candidate>& candidate, const RunOptions& options = {});

/// The same with an index that has been prepared for the problem's discs. Times and counts include those of building it.
[[nodiscard]] Outcome run(const Problem& problem, const Index& index, const RunOptions& options = {});

/// Prepares the search of a technique. Parameters have been checked and belong to the technique.
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
