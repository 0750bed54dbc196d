#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// Counter-based random numbers (Philox4x64-10 of Random123): a pure function of (seed, stream, index, sub_index). So
/// results do not depend on threads, ranks or order.
namespace detp::sim {

/// The purpose of the numbers. Streams never overlap.
enum class Stream : std::uint64_t {
  line_field = 1,
  samples,
  thinning,
  photons,
  scene,
  tests,
  pilot,
  evidence,
  structure,
  reference,
  order
};

/// Four independent uniform numbers in [0, 1) with 53 bits.
[[nodiscard]] std::array<double, 4> uniform4(std::uint64_t seed, Stream stream, std::uint64_t index,
                                             std::uint64_t sub_index = 0);

/// Writes uniform4(seed, stream, first + i) for i = 0 … count - 1: number j of it to columns[j][i]. Takes half the time.
void uniform4(std::uint64_t seed, Stream stream, std::uint64_t first, std::size_t count,
              const std::array<double*, 4>& columns);

/// Four independent 64-bit words.
[[nodiscard]] std::array<std::uint64_t, 4> bits4(std::uint64_t seed, Stream stream, std::uint64_t index,
                                                 std::uint64_t sub_index = 0);

/// Van der Corput's sequence in base 2, in [0, 1): among any 2^k consecutive numbers, one lies in each interval of length
/// 2^-k that starts at a multiple of it.
[[nodiscard]] double van_der_corput(std::uint64_t number);

/// A stratified sample of 0 … size - 1: one number at random of each of `count` equally long runs, in rising order. All
/// numbers if there are not more than `count`.
[[nodiscard]] std::vector<std::size_t> stratified_sample(std::size_t size, std::size_t count, std::uint64_t seed,
                                                         Stream stream);

}  // namespace detp::sim
