#pragma once

#include <cstddef>
#include <functional>
#include <string>

/// Rows of kernels beside what the machine allows.
namespace detp::benchmarks {

/// What one call of a kernel does.
struct Work {
  double tests;             ///< rays against shapes
  double flops;             ///< floating-point operations
  double loaded;            ///< bytes
  double stored;            ///< bytes that are kept
  std::size_t working_set;  ///< bytes: which level of the cache they come from
  double packing;           ///< seconds that packing and storing alone take, if the kernel does
};

/// A row to be measured by Google Benchmark.
void add_row(const std::string& name, const Work& work, std::function<void()> kernel);

/// What machine_peak measures, as text.
void print_peaks();

/// Measures all rows (five times each) and prints the best of each as a line of a table.
void run_rows();

}  // namespace detp::benchmarks
