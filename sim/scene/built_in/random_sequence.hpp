#pragma once

#include "detp/sim/geometry/random.hpp"

namespace detp::sim::built_in {

/// A sequence of uniform random numbers for building a scene. Equal seeds give equal sequences, so a scene with a fixed
/// seed is always the same.
class RandomSequence {
 public:
  explicit RandomSequence(std::uint64_t seed) : seed_(seed) {}

  /// Uniform in [low, high).
  [[nodiscard]] double between(double low, double high) {
    return low + (high - low) * uniform4(seed_, Stream::scene, next_++)[0];
  }

 private:
  std::uint64_t seed_;
  std::uint64_t next_ = 0;
};

}  // namespace detp::sim::built_in
