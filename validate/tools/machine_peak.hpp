#pragma once

#include <cstddef>

/// What this machine does at best, measured by loops that do nothing else. CPU time, the least of several repeats.
namespace detp::benchmarks {

/// Floating-point operations a second: independent fused multiply-adds of floats, two each.
[[nodiscard]] double peak_flops();

/// Bytes a second, loaded from (stored to) an array of so many bytes over and over.
[[nodiscard]] double load_bandwidth(std::size_t bytes);
[[nodiscard]] double store_bandwidth(std::size_t bytes);

/// How lanes are brought together before they are stored.
enum class Packing {
  compress,  ///< each array's by a Compress of its own
  permute    ///< all arrays' by one Compress of the lanes' numbers
};

/// Seconds it takes to load, pack and store (unaligned) one vector of each of `arrays` arrays of `size` floats, of
/// which each lane is kept with probability `share`. arrays: 5 or 7.
[[nodiscard]] double packing_time(Packing packing, int arrays, std::size_t size, double share);

/// Floats in a vector, and what Highway calls the instructions.
[[nodiscard]] std::size_t vector_length();
[[nodiscard]] const char* instructions();

}  // namespace detp::benchmarks
