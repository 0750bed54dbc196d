#pragma once

#include "detp/sim/base/function_ref.hpp"
#include "detp/sim/base/scratch.hpp"
#include "outcome.hpp"
#include "problem.hpp"

/// The search of techniques that trace rays one by one, on any number of threads.
namespace detp::sim {

/// The search object of one thread, with its own mailboxes and counts.
class RaySearch {
 public:
  virtual ~RaySearch() = default;

  /// Appends the hits of rays first … last - 1; those of any one disc in the order of the rays. May throw Stopped.
  virtual void search(std::uint32_t first, std::uint32_t last, FoundPairs& hits) = 0;

  [[nodiscard]] virtual Counts<std::uint64_t> counts() const = 0;
};

/// Makes the search of one thread, in memory of RunOptions::memory.
using MakeRaySearch = FunctionRef<OwnedIn<RaySearch>()>;

/// Searches all rays of the problem and fills in the outcome. Checks for a stop request between chunks of rays; a
/// stopped run keeps the hits of all chunks before the first that was not finished.
///
/// Chunks of 64 rays are searched by options.threads threads at once, each with a search of its own. Their hits are
/// added to the totals chunk after chunk, while later ones are searched, so that powers are summed in the rays' order
/// whatever the threads do. No more than four chunks a thread are under way: in memory are the hits of so many.
///
/// Only one thread adds at a time. That takes 2 ns a hit among 10⁴ discs and 16 among 10⁶ (hits at random), where a
/// grid over 10⁵ discs takes 3 µs to find one: it would take hundreds of threads to wait for it.
void search_rays(const Problem& problem, const RunOptions& options, MakeRaySearch make, Outcome& outcome);

}  // namespace detp::sim
