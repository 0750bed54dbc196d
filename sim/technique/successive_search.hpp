#pragma once

#include <string_view>

#include "detp/sim/search/index.hpp"

/// A search whose rays come in pieces.
namespace detp::sim {

/// Searches an index for the hits of one piece of the rays after another. The outcome is that of one search of all rays, bit for
/// bit, and needs memory for one piece only.
class SuccessiveSearch {
 public:
  /// Keeps references to index, options and `sum`, to which the results are added; its arrays are reused. The rays have the
  /// numbers first … last - 1. `kept_bytes`: of what the caller keeps during the search, for Outcome::bytes. Throws std::invalid_argument for options
  /// out of range, and std::length_error for more than 2³² - 2 rays if pairs are wanted.
  SuccessiveSearch(const Index& index, Problem problem, const RunOptions& options, std::uint64_t first,
                   std::uint64_t last, double kept_bytes, Outcome& sum);

  /// Searches the next rays, which must not begin within a photon's path. Throws as set_rays and Index::search do;
  /// std::length_error, naming the bytes, if the pairs would not fit in memory. If a stop was requested, sum.stopped is set;
  /// nothing may be added then.
  void add(const PathRays& rays);

  /// To be called after pieces: adds what they bring to the discs' irradiance to sum.irradiance_batches, so rarely that it takes little of the
  /// time. Does nothing if options.totals are the caller's.
  void add_batch();

  /// Number of the next ray.
  [[nodiscard]] std::uint64_t next() const { return next_; }
  /// Rays that are searched; fewer than were added if a stop ended the last piece.
  [[nodiscard]] std::uint64_t done() const { return done_; }
  [[nodiscard]] bool stopped() const { return sum_.stopped; }
  /// A stop was requested between pieces.
  void stop() { sum_.stopped = true; }

  /// Stores hits, irradiance and errors, unless options.totals are the caller's. `photons`: number of photons emitted, if more
  /// than the rays show; `scale`: of powers (RaySource).
  void finish(std::uint64_t photons = 0, double scale = 1);

 private:
  void require_pairs(std::uint64_t last) const;
  void add_pairs();

  const Index& index_;
  Problem problem_;
  const RunOptions& options_;
  RunOptions run_;  ///< of a piece
  Totals own_;
  std::uint64_t first_;
  std::uint64_t last_;
  std::uint64_t next_;
  std::uint64_t done_ = 0;
  double kept_bytes_;
  double beside_rays_bytes_;
  double longest_bytes_ = 0;  ///< of a piece's rays
  Outcome part_;
  Outcome& sum_;
  std::uint64_t last_photon_ = 0;
  std::vector<double> irradiance_;  ///< sum over all discs, of finished batches, by band
};

}  // namespace detp::sim
