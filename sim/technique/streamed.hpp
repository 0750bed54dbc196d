#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "detp/sim/rays/ray_source.hpp"
#include "technique.hpp"

/// Searches any number of rays in bounded memory: reads and searches them block by block.
namespace detp::sim {

struct StreamOptions {
  RunOptions
      run;  ///< with run.totals, a part of the rays is added to these; then the outcome has no hits and irradiance
  std::uint64_t first = 0;                         ///< number of the first ray that is searched
  std::optional<std::uint64_t> last = {};          ///< one more than that of the last; default: all rays of the source
  bool count_building = true;                      ///< the outcome's counts include those of building the index
  bool front_facing = false;                       ///< count only rays that arrive at a disc's front
  std::size_t block = 0;                           ///< rays in memory at a time; 0: block_in_memory
  double kept_bytes = 0;                           ///< of the caller, that count against the memory budget, too
  std::function<void(double done)> progress = {};  ///< called before each block, 0 <= done < 1
};

struct StreamedOutcome {
  Outcome outcome;           ///< over all rays; pairs have the rays' numbers in the source
  double read_seconds = 0;   ///< time for making or reading the rays, not in outcome.seconds
  double check_seconds = 0;  ///< time for checking rays and discs and computing S₀; not in outcome.seconds
  std::size_t block = 0;     ///< rays in memory at a time
  double bytes = 0;          ///< predicted peak memory, including discs, a block of rays and the pairs found
};

/// Number of rays that are worth keeping in memory; more are a stream by default: four for each disc, as rays_in_block,
/// but at least 2²⁰ (64 MiB) and at most 2²⁴ (1 GiB).
[[nodiscard]] std::size_t default_block(std::size_t discs);

/// Number of rays of a stream that are in memory at a time: rays_in_block, at least 2¹⁸ (16 MiB), but no more than fit an
/// eighth of the memory budget (and then at least 2¹⁵). Techniques that cull lists visit all discs once for each block, so
/// that smaller ones cost time. Larger ones cost time when their memory is first written.
[[nodiscard]] std::size_t block_in_memory(std::size_t discs);

/// Runs a candidate over any number of rays. The result is that of `run`, bit for bit (hits, irradiance, pairs), for
/// any block size. The index over the discs is built once. `first` and `last` select a part of the rays.
///
/// A stop request also ends the making of rays. The outcome then has `stopped` set, covers only the first rays, and has
/// no pairs. Throws as make_problem and run do. There may be more than 2³² rays, unless pairs are requested. Throws
/// std::length_error, naming the bytes, before the memory budget would be exceeded. The memory of pairs (8 bytes each)
/// is checked again after each block.
[[nodiscard]] StreamedOutcome run_streamed(std::span<const Disc> discs, const RaySource& source,
                                           const Valid<Candidate>& candidate, const StreamOptions& options = {});

}  // namespace detp::sim
