#pragma once

#include <cstddef>
#include <functional>
#include <string>

/// A table of kernel times beside the machine's limits.
namespace detp::benchmarks {

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

/// Prints the measurements of machine_peak.
void print_peaks();

/// Measures each row five times and prints the shortest time as a line of a table.
void run_rows();

}  // namespace detp::benchmarks
