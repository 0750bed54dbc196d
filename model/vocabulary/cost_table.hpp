#pragma once

#include <array>

#include "thread_costs.hpp"
#include "valid.hpp"

namespace detp {

/// The unit costs of each technique by one engine. The same operation may take a different time in each: the kernels, the
/// sizes of the lists and the memory in use differ.
struct CostTable {
  std::array<UnitCosts, technique_records.size()> of_technique{};  ///< in the order of Technique
  std::array<ThreadCosts, technique_records.size()> threads{};     ///< default: more threads are no faster
  Engine engine = Engine::simd;                                    ///< whose costs these are
  /// Standard error of seconds by these costs from right counts, relative to the seconds; 0: not known.
  std::array<double, technique_records.size()> relative_errors{};

  CostTable() = default;
  /// The same costs for all techniques, on one thread.
  CostTable(const UnitCosts& costs) { of_technique.fill(costs); }

  [[nodiscard]] UnitCosts& operator[](Technique technique) { return of_technique[static_cast<std::size_t>(technique)]; }
  [[nodiscard]] const UnitCosts& operator[](Technique technique) const {
    return of_technique[static_cast<std::size_t>(technique)];
  }

  [[nodiscard]] ThreadCosts& threads_of(Technique technique) { return threads[static_cast<std::size_t>(technique)]; }
  [[nodiscard]] const ThreadCosts& threads_of(Technique technique) const {
    return threads[static_cast<std::size_t>(technique)];
  }

  [[nodiscard]] double& relative_error_of(Technique technique) {
    return relative_errors[static_cast<std::size_t>(technique)];
  }
  [[nodiscard]] double relative_error_of(Technique technique) const {
    return relative_errors[static_cast<std::size_t>(technique)];
  }

  bool operator==(const CostTable&) const = default;
};

/// Throws as check(UnitCosts) and check(ThreadCosts), and for an error that is negative or not finite; the message names
/// the technique.
void check(const CostTable& costs);

/// The costs of one technique, which are valid because the table was checked.
[[nodiscard]] inline Valid<UnitCosts> costs_of(const Valid<CostTable>& costs, Technique technique) {
  return Valid<UnitCosts>(costs, costs[technique]);
}

/// The time of a technique's counts with its costs, on `threads` threads.
[[nodiscard]] CostBreakdown price(const Counts<double>& counts, const CostTable& costs, Technique technique,
                                  int threads = 1);

/// A time and the number of threads that it takes.
struct TimeOnThreads {
  int threads = 1;
  CostBreakdown time = {};
};

/// The shortest time of a technique's counts on 1, 2, 4, … or `most_threads` threads. If times are equal, the smaller
/// number.
[[nodiscard]] TimeOnThreads fastest_price(const Counts<double>& counts, const CostTable& costs, Technique technique,
                                          int most_threads);

}  // namespace detp
