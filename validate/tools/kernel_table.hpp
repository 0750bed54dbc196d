#pragma once

#include <cstddef>
#include <functional>
#include <string>

/// A table of kernel times beside the machine's limits.
namespace detp::benchmarks {

// Floating-point operations of one test in kernels-inl.hpp, of lines and of segments. A multiply-add counts as two operations, a comparison,
// minimum or maximum as one. Changes of sign do not count. load_rays works on doubles, whose operations count as two each.
inline constexpr double box_flops[] = {12, 14};
inline constexpr double sphere_flops[] = {20, 22};
inline constexpr double disc_flops[] = {33, 42};
inline constexpr double load_flops = 2 * 30;

/// The work of one call of a kernel.
struct Work {
  double tests;             ///< ray-shape tests
  double flops;             ///< floating-point operations
  double loaded;            ///< bytes
  double stored;            ///< bytes that are kept
  std::size_t working_set;  ///< bytes; determines the cache level from which data are loaded
  double packing;           ///< seconds for packing and storing alone; 0 if the kernel does not pack
};

/// Adds a row: a kernel that Google Benchmark will measure.
void add_row(const std::string& name, const Work& work, std::function<void()> kernel);

/// Prints the peak rates below.
void print_peaks();

/// Measures each row five times and prints the shortest time as a line of a table.
void run_rows();

// Peak rates of this machine (machine_peak.cpp), measured by loops that do nothing else, in CPU time. Each is the best of several
// repeats.

/// Floating-point operations per second: independent fused multiply-adds of floats, which count as two operations each.
[[nodiscard]] double peak_flops();

/// Bytes per second if an array of `bytes` bytes is loaded, or stored, repeatedly.
[[nodiscard]] double load_bandwidth(std::size_t bytes);
[[nodiscard]] double store_bandwidth(std::size_t bytes);

/// The way in which the kept lanes of a vector are moved together before they are stored.
enum class Packing {
  compress,  ///< one Compress for each array
  permute,   ///< one Compress of the lane numbers, then a permutation of each array
  pairs      ///< the same for two vectors at once, whose lanes mostly fit one (AVX-512; elsewhere as permute)
};

/// Seconds to load, pack and store (unaligned) one vector of each of `arrays` arrays of `size` floats. Each lane is
/// kept with probability `share`. arrays: 5 or 7.
[[nodiscard]] double packing_time(Packing packing, int arrays, std::size_t size, double share);

/// Number of floats in a vector, and Highway's name of the instruction set.
[[nodiscard]] std::size_t vector_length();
[[nodiscard]] const char* instructions();

}  // namespace detp::benchmarks
