#pragma once

#include <memory>

#include "outcome.hpp"
#include "problem.hpp"

/// One door to every search: `prepare` builds what depends on the discs alone, `search` uses it.
namespace detp::sim {

/// What building an index took, and what it holds.
struct Built {
  Phases seconds;                ///< of sorting and building
  Counts<std::uint64_t> counts;  ///< of building: sorted, placements, references
  double bytes = 0;              ///< predicted memory while it is built, at its peak
};

/// What a technique makes of discs before it sees a ray: const, so that many threads may search it at once.
class Index {
 public:
  virtual ~Index() = default;

  /// Finds the hits of the problem's rays and fills in the outcome, except for its times. The problem must have the
  /// discs that the index was made for, and no more slack. Counts are those of the search alone. Throws
  /// std::length_error, naming the bytes, before it would take more than the memory budget.
  virtual void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const = 0;

  [[nodiscard]] const Built& built() const { return built_; }

 protected:
  Built built_;
};

/// Throws std::invalid_argument for options that no technique can run with.
void check_options(const RunOptions& options, const Problem& problem);

/// The outcome of a run that was stopped before it searched.
[[nodiscard]] Outcome nothing_found(const Problem& problem, const RunOptions& options);

/// Searches an index for the hits of the problem's rays. Throws as Index::search does, and std::invalid_argument for
/// options out of range. A search that is stopped before it found anything has an outcome without hits.
[[nodiscard]] Outcome search(const Index& index, const Problem& problem, const RunOptions& options);

}  // namespace detp::sim
