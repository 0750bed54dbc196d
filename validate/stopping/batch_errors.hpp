#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "detp/sim/search/irradiance.hpp"

namespace detp::validate {

/// Standard errors and bounds of an irradiance over batches of photons (run_until), from those of the batches. Σ x² adds up over batches. A
/// batch does not keep the largest x of a disc: where its error is weak, it is bounded by w, which its bound tells, and
/// by Σ x, Σ x² and the number of hits: exact if all bring the same. So errors may be called weak where those of all photons at once (sim::finish) are
/// not. The bound has the largest w of all batches, which discs that a batch does not hit tell of others.
class BatchErrors {
 public:
  /// For each disc.
  struct State {
    int unit = 0;                 ///< squares are those of 2^unit x, so that extreme powers neither overflow nor vanish
    std::vector<double> squares;  ///< Σ x², x what a photon brings to the irradiance, times the photons of all batches
    std::vector<double> largest;   ///< bound of the largest x, of batches with a weak error
    std::vector<double> heaviest;  ///< w, of these batches, as if theirs were that of the first
    std::vector<double> unhit;     ///< the same, from a batch that did not hit the disc; 0: all hit it
    double most = 0;               ///< largest w of a batch over that of the first
    std::vector<int> photons;      ///< that hit: 0, 1 or, for more, 2
  };

  [[nodiscard]] bool empty() const { return state_.squares.empty(); }
  [[nodiscard]] const State& state() const { return state_; }
  void set_state(State state) { state_ = std::move(state); }

  /// Adds a batch of so many photons: irradiance, errors and bounds in one band, and the hits of all.
  void add(const sim::BandResults& found, std::span<const std::uint64_t> hits, double photons);

  /// Of the irradiance of all batches, of so many photons together. Nothing before the first batch.
  [[nodiscard]] std::vector<sim::PowerError> of(std::span<const double> irradiance, double photons) const;

 private:
  State state_;
};

}  // namespace detp::validate
