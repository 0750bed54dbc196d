#include "random_order.hpp"

#include <bit>

#include "detp/sim/geometry/random.hpp"

namespace detp::validate {
namespace {

constexpr std::uint64_t rounds =
    4;  // of a Feistel network: with four the order is as good as random (Luby and Rackoff 1988)

}  // namespace

RandomOrder::RandomOrder(std::uint64_t count, std::uint64_t seed)
    : count_(count), seed_(seed), half_bits_(static_cast<int>(std::bit_width(count) + 1) / 2) {}

std::uint64_t RandomOrder::operator[](std::uint64_t place) const {
  // Numbers beyond the count are passed over: at most three in four.
  do place = permuted(place);
  while (place >= count_);
  return place;
}

std::uint64_t RandomOrder::permuted(std::uint64_t number) const {
  const std::uint64_t mask = (std::uint64_t{1} << half_bits_) - 1;
  std::uint64_t left = number >> half_bits_;
  std::uint64_t right = number & mask;
  for (std::uint64_t round = 0; round < rounds; ++round) {
    const std::uint64_t mixed = left ^ (sim::bits4(seed_, sim::Stream::order, right, round)[0] & mask);
    left = right;
    right = mixed;
  }
  return left << half_bits_ | right;
}

}  // namespace detp::validate
