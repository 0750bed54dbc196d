#pragma once

#include <functional>

#include "detp/sim/rays/ray_source.hpp"
#include "technique.hpp"

/// Any number of rays in bounded memory: read in blocks, searched one block after another.
namespace detp::sim {

struct StreamOptions {
  RunOptions run;                                  ///< its totals must be null
  bool front_facing = false;                       ///< count only rays that arrive at a disc's front
  std::size_t block = 0;                           ///< rays in memory at a time; 0: default_block
  std::function<void(double done)> progress = {};  ///< called before each block, 0 <= done < 1
};

struct Streamed {
  Outcome outcome;           ///< over all rays; pairs name rays by their number in the source
  double read_seconds = 0;   ///< making or reading the rays, not in outcome.seconds
  double check_seconds = 0;  ///< checking rays and discs, S₀; not in outcome.seconds either
  std::size_t block = 0;     ///< rays in memory at a time
  double bytes = 0;          ///< predicted memory at its peak, with discs and a block of rays; pairs left out
};

/// As many rays as discs, rounded up to a power of two, but at least 2²⁰ and at most 2²²: 64 to 256 MiB.
///
/// Each block costs techniques that cull lists a pass over the discs, and needs to bring as many rays to pay. The
/// processor's caches have no say: techniques that trace rays one by one walk a block in chunks of 64, and the time of
/// a grid (10⁶ discs) is the same for blocks of 2¹⁶ and of 10⁶ rays.
[[nodiscard]] std::size_t default_block(std::size_t discs);

/// What run gives, bit for bit (hits, irradiance, pairs), whatever the block. The index over the discs is built once.
///
/// A stop request ends it while it makes rays, too; what is given is then what the first rays hit. Throws as
/// make_problem and run do (but there may be more than 2³² rays, unless pairs are asked for), and std::length_error,
/// naming the bytes, before it would take more than the memory budget. Pairs (8 bytes each)
/// are checked as they grow.
[[nodiscard]] Streamed run_streamed(std::span<const Disc> discs, const RaySource& source, const Candidate& candidate,
                                    const StreamOptions& options = {});

}  // namespace detp::sim
