#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <memory_resource>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/page_pool.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/geometry/geometry.hpp"
#include "totals.hpp"

/// The options of a search, and its results.
namespace detp::sim {

// Estimates a sum over a random stream of rays from its first rays.

/// What batches of rays (or of photons) bring, accumulated for a standard error.
struct Batches {
  std::uint64_t count = 0;  ///< number of batches
  std::uint64_t rays = 0;
  double sum = 0;      ///< Σ x
  double squares = 0;  ///< Σ x²/m over the batches, with x of m rays

  /// Adds a batch of at least one ray.
  void add(std::uint64_t batch_rays, double of_batch);

  Batches& operator+=(const Batches& other);
};

/// The estimated sum over all rays.
struct SumEstimate {
  double value = 0;
  std::optional<double> standard_error;  ///< unknown for fewer than two batches
};

/// Estimates the sum over N = `all_rays` independent rays as X N/n, if `batches` has the sum X of n of these rays. The
/// standard error SE follows from the differences between the batches.
///
///     SE² = N (N - n)/n σ²,   σ² = Σ m (x/m - X/n)² / (B - 1)        B batches of m rays that bring x
///
/// σ² is the variance of what one ray brings. For n ≪ N the squared error is σ² N²/n; the factor 1 - n/N accounts for
/// what is already known. `batches` must have at least one ray.
[[nodiscard]] SumEstimate estimate_sum(const Batches& batches, std::uint64_t all_rays);

struct Pair {
  std::uint32_t ray;
  std::uint32_t disc;
  auto operator<=>(const Pair&) const = default;
};

/// Pairs that a search has found so far.
using FoundPairs = std::pmr::vector<Pair>;

/// The time of each phase in seconds.
struct Phases {
  double prepare = 0;  ///< reading a view, and checking rays; only of searches that do so (Searcher)
  double order = 0;    ///< sorting the samples
  double build = 0;    ///< building an index
  double search = 0;   ///< all the rest: rebuilding spheres, traversing, testing discs
  [[nodiscard]] double total() const { return prepare + order + build + search; }
};

struct RunOptions {
  bool count = true;            ///< fill in Outcome::counts; turned off for timing, so that counting costs nothing
  bool pairs = false;           ///< fill in Outcome::pairs
  bool standard_error = false;  ///< fill in Outcome::standard_error and Outcome::upper_bound
  Engine engine = Engine::simd;
  std::stop_token stop = {};  ///< checked in every phase, after fewer than 2 StopCheck::most_work units of work
  /// 0: all threads of the caller's oneTBB arena, outside of one all cores; at most 4096. Results and counts do not
  /// depend on the number. Techniques that trace rays one by one use all threads, plain techniques that cull lists of
  /// rays use one.
  int threads = 1;
  /// Unless null: sums over earlier rays (empty: none), to which the run adds; standard errors if the totals keep them. The
  /// caller gets the results by `finish` (irradiance.hpp). Runs over successive rays, none of which begins within a photon's
  /// path, give the same bits as one run over all rays.
  Totals* totals = nullptr;
  /// Memory for a search's arrays, except those that it returns. A Scratch keeps the memory for the next search.
  std::pmr::memory_resource* memory = &page_pool();
  /// Unless empty: called now and then during the search, with the share of the rays that are searched (ray-map and
  /// photon-map: of the discs), and with 1 after a search that was not stopped. The simd engine calls it before each block of rays; plain techniques with lists of rays
  /// do not call it. Calls do not overlap, but may come from different threads. It may request a stop.
  std::function<void(double share)> progress = {};
};

/// Reports the progress of a search by discs, from time to time.
inline void report_share(const RunOptions& options, std::size_t done, std::size_t discs) {
  if (options.progress && done % 64 == 0) options.progress(static_cast<double>(done) / static_cast<double>(discs));
}

/// Numbers of SIMD vectors that the simd engine processed, full or not. They depend on the instruction set.
struct Vectors {
  std::uint64_t cull = 0;  ///< vectors of rays tested against a sphere or box
  std::uint64_t test = 0;  ///< vectors of rays tested against a disc

  Vectors& operator+=(const Vectors& more) {
    cull += more.cull;
    test += more.test;
    return *this;
  }
};

/// Counts of one sphere of the cache.
struct SphereCounts {
  std::uint64_t rebuilds = 0;  ///< number of builds
  std::uint64_t tests = 0;     ///< ray-sphere tests of all builds
  std::uint64_t listed = 0;    ///< rays listed in all builds
};

/// What a technique finds in one band of powers, per disc in the order of the problem's discs.
struct BandResults {
  /// Power of the rays that cross the disc, divided by the disc's area π d². Powers are added in the order of Totals, so
  /// all exact techniques give the same bits.
  std::vector<double> irradiance;
  /// Standard error of the irradiance, for independent photons (irradiance.hpp); infinite, for not known, if fewer than two photons hit the
  /// disc; weak (is_weak) if a few bring most of it. Empty if not requested, or if the run was stopped and its rays are no stream.
  std::vector<double> standard_error;
  std::vector<double> upper_bound;  ///< one-sided bound of the irradiance, 95 %; empty like standard_error
  /// of streams: sum over all discs of what the first rays bring to their irradiance, batch by batch, without the scale of the source
  Batches irradiance_batches;
};

/// The results of a technique. Those of band 0 are its own.
struct Outcome : BandResults {
  std::vector<std::uint64_t> hits;   ///< rays that cross the disc
  std::vector<BandResults> further;  ///< bands 1, 2, …
  std::uint64_t total_hits = 0;
  Counts<std::uint64_t> counts;       ///< all zero unless requested (`hits` always holds total_hits)
  Vectors vectors;                    ///< of the simd engine
  std::vector<SphereCounts> spheres;  ///< S₁ … S_k of a sphere cache; empty unless counts are requested
  std::vector<Pair> pairs;            ///< sorted by ray, then disc; empty if not requested, or if the run was stopped
  /// Predicted peak memory, in addition to rays and discs, checked before it is allocated. Does not include memory that
  /// the heap keeps after arrays are freed.
  double bytes = 0;
  Phases seconds;
  bool stopped = false;  ///< true if a stop request ended the run: hits and irradiance are partial
  /// The progress of the run. If its unit is rays, hits and irradiance are exactly those of the first `done` rays. If
  /// its unit is discs, the `done` discs marked in done_discs were tested against all rays; hits and irradiance of the
  /// other discs are 0 and have no meaning.
  Progress progress;
  std::vector<bool> done_discs;  ///< empty unless the progress is in discs
  Batches batches;               ///< hits of the finished rays, batch by batch; empty if the progress is in discs

  [[nodiscard]] std::size_t bands() const { return 1 + further.size(); }
  [[nodiscard]] BandResults& band(std::size_t band) { return band == 0 ? *this : further[band - 1]; }
  [[nodiscard]] const BandResults& band(std::size_t band) const { return band == 0 ? *this : further[band - 1]; }
  /// There are no errors of a part.
  void clear_errors() {
    for (std::size_t i = 0; i < bands(); ++i) {
      band(i).standard_error.clear();
      band(i).upper_bound.clear();
    }
  }
};

/// Empties an outcome, and keeps the memory of its arrays.
void clear(Outcome& outcome);

/// Adds the outcome of a search of further rays: counts, hits, batches and the time of the search; `stopped` becomes that of
/// the part. Progress, pairs and what follows from totals are left to the caller.
void add_block(const Outcome& part, Outcome& sum);

/// For a stopped outcome whose finished discs are marked in done_discs. Sets hits and irradiance of the other discs to
/// 0, sets progress to the number of marked discs, and recomputes total_hits.
void keep_done_discs(Outcome& outcome);

}  // namespace detp::sim
