#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "detp/sim/base/scratch.hpp"
#include "detp/sim/search/index.hpp"
#include "detp/sim/search/views.hpp"

namespace detp::sim {

/// The problem of a Searcher: without rays, which may start at most `farthest` from the centre of S₀, the sphere around
/// all discs (default: 1000 radii of S₀). Throws as make_problem_without_rays.
[[nodiscard]] Problem searched_problem(std::span<const Disc> discs, std::optional<double> farthest, bool front_facing,
                                       const std::stop_token& stop);

/// Memory for one search at a time, kept for the next search.
struct SearchScratch {
  Scratch memory;
  std::vector<Ray> rays;        ///< a piece of a view
  std::vector<double> further;  ///< its powers in further bands
  Outcome outcome;
};

/// Discs prepared for one technique, to be searched again and again with new rays, as in a renderer's loop.
///
/// What depends on the discs alone is built once. A searcher is const: many threads may search it at once, each with
/// its own scratch. If a search on one thread is repeated at the same size, it takes nothing from the heap (except for
/// pairs, for photon-map, for views of more rays than a piece, and inside oneTBB).
class Searcher {
 public:
  /// Borrows the discs, which must outlive the searcher; copies them if a normal must be normalised. No ray may start
  /// farther than `farthest` from the centre of S₀, the sphere around all discs (default: 1000 radii of S₀). Of the
  /// options, only the engine, the threads and the stop token matter here. Throws as make_problem and run do; Stopped
  /// on a stop request.
  Searcher(std::span<const Disc> discs, const Candidate& candidate, std::optional<double> farthest = {},
           bool front_facing = false, const RunOptions& options = {});

  /// The same, but copies the discs.
  Searcher(const DiscsView& discs, const Candidate& candidate, std::optional<double> farthest = {},
           bool front_facing = false, const RunOptions& options = {});

  /// Takes a problem without rays (searched_problem), and an index that was prepared for it. The problem's discs
  /// must outlive the searcher.
  Searcher(Problem problem, std::unique_ptr<Index> index) : problem_(std::move(problem)), index_(std::move(index)) {}

  /// Finds the hits of the rays, as run does. Returns scratch.outcome, which is valid until the scratch's next search.
  /// Counts and seconds are those of the search alone. Throws as run does, and std::invalid_argument if a ray starts
  /// too far away.
  const Outcome& search(const PathRays& rays, SearchScratch& scratch, RunOptions options = {}) const;
  /// The same for views, which are read in pieces of 2¹⁸ rays, 16 MiB. (The plain engine: default_block. ray-map: all rays.)
  const Outcome& search(const RaysView& rays, SearchScratch& scratch, const RunOptions& options = {}) const;

  /// Counts, time and memory of building the index.
  [[nodiscard]] const Built& built() const { return index_->built(); }

 private:
  /// The rays first … first + count - 1 of a view, copied to the scratch.
  static PathRays read(const RaysView& rays, std::size_t first, std::size_t count, SearchScratch& scratch, int threads);
  /// Number of rays of a view that are read at a time.
  [[nodiscard]] std::size_t piece(Engine engine) const;
  void search_pieces(const RaysView& rays, std::size_t piece, SearchScratch& scratch, RunOptions options) const;

  /// Uses the copies if there are any, else the borrowed discs.
  Searcher(std::vector<Disc> copies, std::span<const Disc> borrowed, const Candidate& candidate,
           std::optional<double> farthest, bool front_facing, const RunOptions& options);

  std::vector<Disc> own_discs_;
  Problem problem_;  ///< without rays
  std::unique_ptr<Index> index_;
};

}  // namespace detp::sim
