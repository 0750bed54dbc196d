#pragma once

#include <vector>

#include "engine.hpp"
#include "unit_costs.hpp"

namespace detp {

/// How a technique's time depends on the number of threads: Amdahl's law for each of two phases.
///
///     T(n) = P (p + (1 - p) / m_P) + S (s + (1 - s) / m_S) + a (n - 1)
///     m    = w / ⌈w / n⌉
///
///   where  P, S   time on one thread: of sorting and building, and of everything else
///          p, s   serial shares of P and S
///          w      number of equal pieces into which the phase's work is divided (pieces_of); m: threads kept busy by them
///          a      time for starting one further thread
///
/// Source         G. M. Amdahl (1967); the pieces and the time for a start are ours.
/// Assumptions    each of the n threads has a core of its own. If threads share cores or memory bandwidth, the fitted
///                serial shares contain that.
struct ThreadCosts {
  double serial_preparing = 1;  ///< p, from 0 to 1
  double serial_search = 1;     ///< s, from 0 to 1
  double start = 0;             ///< a, seconds

  bool operator==(const ThreadCosts&) const = default;
};

/// Throws std::invalid_argument if a share is not from 0 to 1, or if the time for a start is negative or not finite.
void check(const ThreadCosts& costs);

/// Numbers of equal pieces of work; 1: one thread does all.
struct Pieces {
  double preparing = 1;
  double search = 1;
};

/// The pieces into which the engine divides the work of a search with these counts (TechniqueRecord::division).
[[nodiscard]] Pieces pieces_of(const Counts<double>& counts, Technique technique, Engine engine);

/// Number of threads that equal pieces keep busy on average, if there are `threads`: at most `threads`.
[[nodiscard]] double busy_threads(double pieces, int threads);

/// The time on `threads` >= 1 threads, from that on one. The same if no phase is divided.
[[nodiscard]] CostBreakdown on_threads(const CostBreakdown& one, const Pieces& pieces, const ThreadCosts& costs,
                                       int threads);

/// The numbers of threads among which a choice is made: 1, 2, 4, … and `most` >= 1.
[[nodiscard]] std::vector<int> thread_numbers(int most);

}  // namespace detp
