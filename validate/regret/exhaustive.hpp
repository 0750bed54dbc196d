#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/search/outcome.hpp"

namespace detp::sim {
class Problem;
}

/// Measures many candidates on the same rays and discs, and finds the fastest.
namespace detp::validate {

/// A candidate that was measured.
struct Timed {
  Candidate candidate;
  bool abandoned = false;             ///< it took too long; its seconds are a lower bound
  std::vector<double> seconds = {};   ///< of each run: sorting, building, searching
  sim::Phases phases = {};            ///< of the fastest run
  Counts<std::uint64_t> counts = {};  ///< of the first run; zero if it was abandoned
  sim::Vectors vectors = {};          ///< of the first run

  /// The shortest time of the runs with even numbers, on which the best candidate is selected.
  [[nodiscard]] double selecting_seconds() const;
  /// The shortest time of the runs with odd numbers, on which all are judged.
  [[nodiscard]] double judging_seconds() const;
};

struct ExhaustiveOptions {
  int repeats = 6;      ///< timed runs of the candidates that are not far behind; at least 2
  double patience = 4;  ///< a first run is abandoned after this many times the shortest time so far, but at least 5 ms
  double behind = 1.5;  ///< candidates that first take more than this many times the shortest time are run only twice
  int threads = 1;
  std::stop_token stop = {};
};

struct Exhaustive {
  std::vector<Timed> candidates;  ///< first those that were asked for, in their order, then neighbours
  std::size_t best = 0;           ///< the fastest on the selecting half
  double noise = 1;               ///< judging over selecting time of the best
  bool stopped = false;
};

/// Measures the candidates `asked`, all exact techniques with their default parameters, and neighbours of the fastest
/// two until none of them is faster. Then times those in turns, round after round.
[[nodiscard]] Exhaustive measure_all(const sim::Problem& problem, std::span<const Candidate> asked,
                                     const ExhaustiveOptions& options = {});

}  // namespace detp::validate
