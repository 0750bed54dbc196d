#pragma once

#include <cstdint>

namespace detp::validate {

/// The numbers 0 … count - 1, each once, in an order that the seed decides. Takes no memory.
class RandomOrder {
 public:
  RandomOrder(std::uint64_t count, std::uint64_t seed);

  /// `place` < count.
  [[nodiscard]] std::uint64_t operator[](std::uint64_t place) const;

 private:
  /// A permutation of the numbers of 2 half_bits_ bits.
  [[nodiscard]] std::uint64_t permuted(std::uint64_t number) const;

  std::uint64_t count_;
  std::uint64_t seed_;
  int half_bits_ = 1;
};

}  // namespace detp::validate
