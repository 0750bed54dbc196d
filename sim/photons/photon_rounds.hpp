#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "detp/sim/base/stopped.hpp"

namespace detp::sim {

/// Decides how many photons to trace for a wanted number of path pieces. Works in rounds, because the number of pieces
/// per photon is known only from photons already traced. The rounds affect how many photons are traced in vain, but not
/// the result.
class PhotonRounds {
 public:
  /// `most_in_a_round`: photons.
  PhotonRounds(std::string scene, std::uint64_t pieces, std::uint64_t most_in_a_round = 1ULL << 20)
      : scene_(std::move(scene)), pieces_(pieces), most_in_a_round_(most_in_a_round), limit_(1000 + 100 * pieces) {}

  /// Number of photons in the next round: about as many as yield the missing pieces. `found` is the number of pieces in
  /// all rounds so far. Throws std::invalid_argument if the limit is reached.
  [[nodiscard]] std::uint64_t next(std::uint64_t found) { return next(found, pieces_); }
  /// The same, to `wanted` pieces for now.
  [[nodiscard]] std::uint64_t next(std::uint64_t found, std::uint64_t wanted) {
    if (traced_ >= limit_)
      throw std::invalid_argument("the light of " + scene_ + " hardly meets its surfaces: " + std::to_string(traced_) +
                                  " photons gave " + std::to_string(found) + " pieces of path (" +
                                  std::to_string(pieces_) + " asked for)");
    const std::uint64_t photons = std::min(photons_needed(found, wanted), limit_ - traced_);
    traced_ += photons;
    return photons;
  }

  /// Number of photons after which to give up.
  [[nodiscard]] std::uint64_t limit() const { return limit_; }

 private:
  static constexpr std::uint64_t least_in_a_round = 256;  ///< also of the first, for paths may be long
  static constexpr std::uint64_t most_in_second_round = 1ULL << 14;

  [[nodiscard]] std::uint64_t photons_needed(std::uint64_t found, std::uint64_t wanted) const {
    const std::uint64_t missing = wanted - found;
    if (traced_ == 0) return least_in_a_round;
    const double each = static_cast<double>(found) / static_cast<double>(traced_);
    const double margin = 1 + 2 / std::sqrt(static_cast<double>(traced_));  // so that a further round is rarely needed
    const double more = each > 0 ? margin * static_cast<double>(missing) / each : 2.0 * static_cast<double>(traced_);
    const std::uint64_t round = traced_ < most_in_second_round ? most_in_second_round : most_in_a_round_;
    const auto most = static_cast<double>(std::min(round, limit_));
    return std::max(least_in_a_round, static_cast<std::uint64_t>(std::min(more, most)));
  }

  std::string scene_;
  std::uint64_t pieces_;
  std::uint64_t most_in_a_round_;
  std::uint64_t limit_;
  std::uint64_t traced_ = 0;
};

/// Throws Stopped; the message says how many of the rays have been traced.
[[noreturn]] inline void stopped_tracing(std::uint64_t rays, std::uint64_t of) {
  throw Stopped("stopped while tracing photons after " + std::to_string(rays) + " of " + std::to_string(of) + " rays",
                {rays, of, "rays"});
}

}  // namespace detp::sim
