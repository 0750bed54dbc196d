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

}  // namespace detp::sim
