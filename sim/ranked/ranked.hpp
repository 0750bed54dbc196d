#pragma once

#include <memory>

#include "detp/sim/geometry/disc_source.hpp"
#include "detp/sim/ranks/ranks.hpp"
#include "detp/sim/search/photon_sums.hpp"
#include "detp/sim/technique/streamed.hpp"
#include "part_results.hpp"

/// A search of streamed rays that ranks share.
namespace detp::sim {

/// Rays first … last - 1 of a source: all photons of the blocks of photons from `block` to `next_block` - 1.
struct ShareOfRays {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  std::uint64_t block = 0;
  std::uint64_t next_block = 0;
};

/// About the memory that a search needs for each disc: the disc with its results, a box tree, and totals of 2¹² blocks.
inline constexpr double bytes_of_disc = 400;

/// What ranks share.
enum class Share { rays, discs };

struct RankedOutcome {
  StreamedOutcome found;
  std::vector<double> seconds = {};  ///< on rank 0: those that each rank needed for its share; empty if there is one
  /// on rank 0, if the discs are not in memory: hits, irradiance and pairs, which `found` then lacks
  std::shared_ptr<const PartResults> results = {};
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
/// Share::discs: each rank makes all rays, and searches them for its discs, a part of the Morton curve (DiscCut); the index
/// and the sums are those of its discs. For at least 2²¹ rays and four for each disc, the time of the first 2¹⁷ rays is measured; if its imbalance is
/// over 15 %, discs are shared anew by it, once. Rays are loaded and culled, and counted, on each rank. Throws Stopped on all ranks if one was
/// stopped, and std::invalid_argument for fewer discs than ranks. A rank whose discs do not fit in memory searches all rays for one part of them
/// after another; then nothing is shared anew. One rank alone does the same. If the discs are in memory and pairs are requested, it throws
/// std::length_error instead.
///
/// Discs that are not in memory are always shared. Each rank reads all of them, and keeps its part.
[[nodiscard]] RankedOutcome run_on_ranks(const DiscSource& discs, const RaySource& source,
                                         const Valid<Candidate>& candidate, const StreamOptions& options, Ranks& ranks,
                                         Share share = Share::rays);
[[nodiscard]] RankedOutcome run_on_ranks(std::span<const Disc> discs, const RaySource& source,
                                         const Valid<Candidate>& candidate, const StreamOptions& options, Ranks& ranks,
                                         Share share = Share::rays);

/// One process searches all rays for one part of the discs after another. Throws Stopped, and as run_streamed.
[[nodiscard]] RankedOutcome run_in_parts(const DiscSource& discs, const RaySource& source,
                                         const Valid<Candidate>& candidate, const StreamOptions& options, int parts);

/// Rays, which balance best; discs where their index and sums would not fit in the memory of a rank. The same on all ranks.
[[nodiscard]] Share usual_share(std::size_t discs, Ranks& ranks);

}  // namespace detp::sim
