#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/progress.hpp"
#include "hit_batches.hpp"
#include "totals.hpp"

/// How a search is run, and what it found.
namespace detp::sim {

struct Pair {
  std::uint32_t ray;
  std::uint32_t disc;
  auto operator<=>(const Pair&) const = default;
};

/// Where the time went, in seconds.
struct Phases {
  double order = 0;   ///< sorting the samples
  double build = 0;   ///< building an index
  double search = 0;  ///< all the rest: rebuilding spheres, traversing, testing discs
  [[nodiscard]] double total() const { return order + build + search; }
};

struct RunOptions {
  bool count = true;   ///< fill in Outcome::counts; a timing run turns it off and pays nothing for it
  bool pairs = false;  ///< fill in Outcome::pairs
  Engine engine = Engine::simd;
  std::stop_token stop = {};  ///< checked in every phase, after at most StopCheck::most_work units of work
  /// 0: all cores; at most 4096. What is found and counted does not depend on it. Techniques that trace rays one by one
  /// use them all, those that cull lists of rays one.
  int threads = 1;
  /// Sums of rays before these: the run adds to them and leaves hits and irradiance to `finish`. If empty, it starts
  /// them. So blocks of rays run one after another give, bit for bit, what one run over all of them gives.
  Totals* totals = nullptr;
};

/// Vectors of lanes that the simd engine spent, full or not. They depend on the instruction set.
struct Vectors {
  std::uint64_t cull = 0;  ///< of rays tested against a sphere or box
  std::uint64_t test = 0;  ///< of rays tested against a disc

  Vectors& operator+=(const Vectors& more) {
    cull += more.cull;
    test += more.test;
    return *this;
  }
};

/// What happened to one sphere of the cache, counted.
struct SphereCounts {
  std::uint64_t rebuilds = 0;  ///< times it was built
  std::uint64_t tests = 0;     ///< ray-sphere tests of all its builds
  std::uint64_t listed = 0;    ///< rays listed by all its builds
};

/// What a technique found, per disc in the order of the problem's discs.
struct Outcome {
  std::vector<std::uint64_t> hits;  ///< rays that cross the disc
  /// Their power over π d²: ((x + y) + z) / π d², each of x, y, z the sum, in the rays' order, over the rays of that
  /// dominant_axis. All exact techniques give the same bits.
  std::vector<double> irradiance;
  std::uint64_t total_hits = 0;
  Counts<std::uint64_t> counts;       ///< all zero unless asked for (`hits` always holds total_hits)
  Vectors vectors;                    ///< of the simd engine
  std::vector<SphereCounts> spheres;  ///< S₁ … S_k of a sphere cache; empty unless counting
  std::vector<Pair> pairs;            ///< sorted by ray, then disc; empty unless asked for, and of a stopped run
  /// Predicted memory at its peak, beside rays and discs, checked before it was taken; what the heap keeps of arrays
  /// that were freed is left out.
  double bytes = 0;
  Phases seconds;
  bool stopped = false;  ///< a stop request ended the run: hits and irradiance are partial
  /// How far the run came. In rays: hits and irradiance are those of the first `done` rays, none of whose hits is
  /// missing. In discs: `done` discs, those marked in done_discs, were tested against all rays; hits and irradiance of
  /// the others are 0 and say nothing.
  Progress progress;
  std::vector<bool> done_discs;  ///< empty unless progress is in discs
  HitBatches batches;            ///< the hits of the rays done, batch by batch; empty where progress is in discs
};

/// Fills in the outcome's hits and irradiance from totals, one for each disc.
void finish(const Totals& totals, std::span<const Disc> discs, Outcome& outcome);

/// Of a stopped outcome whose done_discs are marked: drops the hits of all other discs, and sets its progress and
/// total.
void keep_done_discs(Outcome& outcome);

}  // namespace detp::sim
