#pragma once

#include <memory>

#include "outcome.hpp"
#include "problem.hpp"

/// The interface of every search: `prepare` builds the index, which depends on the discs alone; `search` uses it.
namespace detp::sim {

/// The time and memory for building an index, and its counts.
struct Built {
  Phases seconds;                ///< for sorting and building
  Counts<std::uint64_t> counts;  ///< of building: sorted, made, placements, references
  double bytes = 0;              ///< predicted peak memory while the index is built
};

/// The data structure that a technique builds from the discs, before any ray. It is const, so many threads may search
/// it at once.
class Index {
 public:
  virtual ~Index() = default;

  /// Finds the hits of the problem's rays and fills in the outcome, except for the time of the search. The problem must
  /// have the discs from which the index was made, and its slack must be at most the slack with which the index was
  /// made. Counts are those of the search alone.
  /// Throws std::length_error, naming the bytes, before the memory budget would be exceeded.
  virtual void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const = 0;

  /// Sorts all rays of a search, so that it would do more work if they came in pieces.
  [[nodiscard]] virtual bool sorts_rays() const { return false; }

  [[nodiscard]] const Built& built() const { return built_; }

 protected:
  Built built_;
};

/// Throws std::invalid_argument for options that are invalid for every technique.
void check_options(const RunOptions& options, const Problem& problem);

/// The outcome of a run that was stopped before its search.
[[nodiscard]] Outcome unsearched_outcome(const Problem& problem, const RunOptions& options);

/// Searches an index for the hits of the problem's rays. Throws as Index::search does, and std::invalid_argument for
/// options out of range. A stop request does not throw: it sets Outcome::stopped. If it came before the search, the
/// outcome has no hits.
[[nodiscard]] Outcome search(const Index& index, const Problem& problem, const RunOptions& options);

/// The same, but writes into `outcome` and reuses its arrays.
void search(const Index& index, const Problem& problem, const RunOptions& options, Outcome& outcome);

}  // namespace detp::sim
