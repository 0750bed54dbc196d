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

  /// Appends the hits of rays first … last - 1; the hits of each disc are in ray order. May throw Stopped.
  virtual void search(std::uint32_t first, std::uint32_t last, FoundPairs& hits) = 0;

  [[nodiscard]] virtual Counts<std::uint64_t> counts() const = 0;
};

/// Makes the search of one thread, in memory of RunOptions::memory.
using MakeRaySearch = FunctionRef<OwnedIn<RaySearch>()>;

/// Searches all rays of the problem and fills in the outcome. Checks for a stop request between chunks of rays. A
/// stopped run keeps the hits of all chunks before the first unfinished one.
///
/// options.threads threads search chunks of 64 rays or a little more, whole photons, in parallel, each with its own search object. Meanwhile the hits of
/// finished chunks are added to the totals, chunk by chunk, so powers are always summed in ray order. At most four
/// chunks per thread are in flight, which limits the hits in memory.
///
/// Only one thread adds hits at a time. Adding a hit takes 2 ns for 10⁴ discs and 16 ns for 10⁶ (hits at random);
/// finding a hit in a grid over 10⁵ discs takes 3 µs. So threads would have to wait only if they were hundreds.
void search_rays(const Problem& problem, const RunOptions& options, MakeRaySearch make, Outcome& outcome);

}  // namespace detp::sim
