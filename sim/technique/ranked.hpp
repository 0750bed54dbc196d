#pragma once

#include "detp/sim/ranks/ranks.hpp"
#include "detp/sim/search/photon_blocks.hpp"
#include "streamed.hpp"

/// A search of streamed rays that ranks share.
namespace detp::sim {

/// Rays first … last - 1 of a source: all photons of the blocks of photons from `block` to `next_block` - 1.
struct ShareOfRays {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  std::uint64_t block = 0;
  std::uint64_t next_block = 0;
};

/// What ranks share.
enum class Share { rays, discs };

struct RankedOutcome {
  StreamedOutcome found;
  std::vector<double> seconds = {};  ///< on rank 0: those that each rank needed for its share; empty if there is one
};

/// The slowest rank's seconds over their mean, less 1.
[[nodiscard]] double imbalance(std::span<const double> seconds);

/// run_streamed on all ranks. All must have the same discs, source, candidate and options. On rank 0 the outcome is that of
/// run_streamed, bit for bit, for any number of ranks; counts and vectors are sums over the ranks, seconds those of the slowest in each phase. On
/// the others it has the counts of its share. What fails on one rank throws on all: there what was thrown, RankFailed elsewhere.
///
/// Share::rays: each rank makes and searches whole blocks of photons, with an index of all discs. If there are 16 blocks for each, ranks are
/// compared after an eighth; if the imbalance is over 15 %, the rest is shared anew by their speeds, once. Stopped on some ranks, the outcome has the hits of
/// the first rays only, up to the first block that is not complete.
///
/// Share::discs: each rank makes all rays, and searches them for its discs, a part of the Morton curve by a cost of 1 + d²/mean d² each; the index
/// and the sums are those of its discs. For at least 2²¹ rays and four for each disc, the time of the first 2¹⁷ rays is measured; if its imbalance is
/// over 15 %, discs are shared anew by it, once. Rays are loaded and culled, and counted, on each rank. Throws Stopped on all ranks if one was
/// stopped, and std::invalid_argument for fewer discs than ranks.
[[nodiscard]] RankedOutcome run_on_ranks(std::span<const Disc> discs, const RaySource& source,
                                         const Valid<Candidate>& candidate, const StreamOptions& options, Ranks& ranks,
                                         Share share = Share::rays);

/// One process searches all rays for one part of the discs after another. No standard errors. Throws Stopped, and as run_streamed.
[[nodiscard]] StreamedOutcome run_in_parts(std::span<const Disc> discs, const RaySource& source,
                                           const Valid<Candidate>& candidate, const StreamOptions& options, int parts);

/// run_streamed; if that does not fit in memory, and there are no pairs and standard errors, run_in_parts with as few parts as fit, a power of 2.
/// Throws as run_streamed.
[[nodiscard]] StreamedOutcome run_in_memory(std::span<const Disc> discs, const RaySource& source,
                                            const Valid<Candidate>& candidate, const StreamOptions& options);

/// Rays, which balance best; discs where their index and sums would not fit in a rank's memory.
[[nodiscard]] Share usual_share(std::size_t discs, int ranks);

}  // namespace detp::sim
