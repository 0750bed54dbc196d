#pragma once

#include <array>
#include <cstdint>

/// Counter-based random numbers (Philox4x64-10 of Random123): a pure function of (seed, stream, index, sub_index). So
/// results do not depend on threads, ranks or order.
namespace detp::sim {

/// The purpose of the numbers. Streams never overlap.
enum class Stream : std::uint64_t { line_field = 1, samples, thinning, photons, scene, tests };

/// Four independent uniform numbers in [0, 1) with 53 bits.
[[nodiscard]] std::array<double, 4> uniform4(std::uint64_t seed, Stream stream, std::uint64_t index,
                                             std::uint64_t sub_index = 0);

/// Four independent 64-bit words.
[[nodiscard]] std::array<std::uint64_t, 4> bits4(std::uint64_t seed, Stream stream, std::uint64_t index,
                                                 std::uint64_t sub_index = 0);

}  // namespace detp::sim
