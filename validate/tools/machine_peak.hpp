#pragma once

#include <cstddef>

/// Peak rates of this machine, measured by loops that do nothing else, in CPU time. Each is the best of several
/// repeats.
namespace detp::benchmarks {

/// Floating-point operations per second: independent fused multiply-adds of floats, which count as two operations each.
[[nodiscard]] double peak_flops();

/// Bytes per second if an array of `bytes` bytes is loaded, or stored, repeatedly.
[[nodiscard]] double load_bandwidth(std::size_t bytes);
[[nodiscard]] double store_bandwidth(std::size_t bytes);

/// The way in which the kept lanes of a vector are moved together before they are stored.
enum class Packing {
  compress,  ///< one Compress for each array
  permute    ///< one Compress of the lane numbers, then a permutation of each array
};

/// Seconds to load, pack and store (unaligned) one vector of each of `arrays` arrays of `size` floats. Each lane is
/// kept with probability `share`. arrays: 5 or 7.
[[nodiscard]] double packing_time(Packing packing, int arrays, std::size_t size, double share);

/// Number of floats in a vector, and Highway's name of the instruction set.
[[nodiscard]] std::size_t vector_length();
[[nodiscard]] const char* instructions();

}  // namespace detp::benchmarks
