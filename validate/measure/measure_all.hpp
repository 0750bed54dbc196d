#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/phase.hpp"

namespace detp::sim {
class Problem;
}

/// Measures many candidates on the same rays and discs, and finds the fastest.
namespace detp::validate {

/// The exact techniques that none of these candidates uses, with default parameters.
[[nodiscard]] std::vector<Candidate> techniques_left_out(const std::vector<Candidate>& candidates);

/// Candidates of the same technique that differ in one parameter. Numbers are changed one step up and one step down
/// (Parameter::step), within their range. A parameter with named choices is changed only if the technique has no other
/// parameter.
[[nodiscard]] std::vector<Candidate> neighbours(const Candidate& candidate);

/// A candidate on a number of threads.
struct Contender {
  Candidate candidate;
  int threads = 1;

  friend bool operator==(const Contender&, const Contender&) = default;
};

/// A contender that was run. Its times are in seconds (OwnTime) and include sorting, building and searching.
struct Timed {
  Contender contender;
  bool abandoned = false;              ///< it took too long; its seconds are a lower bound
  double first_seconds = 0;            ///< of the first run, or the time after which that run was abandoned
  Counts<std::uint64_t> counts = {};   ///< of the first run; zero if it was abandoned
  std::vector<double> selecting = {};  ///< times from which the best candidate is selected
  std::vector<double> judging = {};    ///< times by which the candidates are judged

  /// The median of the times `judging`; `first_seconds`, a lower bound, if the candidate was abandoned. Throws
  /// std::invalid_argument if the candidate was not judged.
  [[nodiscard]] double judging_seconds() const;
  /// median_ratio() of the times `judging` to those of `reference`; if the candidate was abandoned, the ratio of
  /// judging_seconds().
  [[nodiscard]] double judged_ratio(const Timed& reference) const;
};

/// The index of the candidate that is fastest by the times `selecting`: the one with the least median_ratio() to one of
/// them. nullopt if none has such times.
[[nodiscard]] std::optional<std::size_t> fastest_selected(std::span<const Timed> candidates);

/// A contender that cannot be run here.
struct Refused {
  Contender contender;
  std::string reason;  ///< its index does not fit in memory
};

struct ExhaustiveOptions {
  int repeats = 9;  ///< rounds of each half; more, up to 60, if the fastest run takes less than 2 ms
  /// no further round of a half begins after this many seconds
  double most_seconds = 4;
  /// a first run is abandoned after this many times the shortest time so far, but at least 5 ms
  double patience = 4;
  double patience_if_asked = 10;  ///< the same for a candidate that was asked for
  double least_patience = 0.005;  ///< seconds after which a first run may be abandoned
  double behind =
      1.5;  ///< while the best is selected, one that is slower by more than this factor is timed in four rounds only
  int threads = 1;               ///< most threads
  bool vary_threads = true;      ///< also the fastest on half and twice as many threads
  int rounds_of_neighbours = 6;  ///< at most
  Engine engine = Engine::simd;
  std::vector<Technique> disabled = {};  ///< techniques that are not added to those asked for
  std::stop_token stop = {};
  sim::ReportPhase progress = {};
};

struct Exhaustive {
  std::vector<Timed> candidates;  ///< those asked for, in their order, then the others; without those refused
  std::vector<Refused> refused;
  std::optional<std::size_t> best;  ///< the fastest on the selecting half; nullopt if the search was stopped before
  double noise = 1;      ///< judged_ratio() of the best to itself, timed a second time as if it were another candidate
  bool stopped = false;  ///< a stop was requested before the end

  /// Null if it was not run.
  [[nodiscard]] const Timed* find(const Contender& contender) const;
};

/// Runs each of these once: those `asked` for, all other exact techniques with default parameters on all threads that they can use, and
/// neighbours of the fastest two, also on half and twice as many threads, until none of them is faster. Those whose first
/// time is at most three times the shortest then take turns (timed_rounds), and the fastest of them is the best. Then
/// those asked for and the best, entered twice, take turns and are judged. So nothing is judged by the times for which it
/// was selected. The first one asked for is never abandoned. Throws as sim::run does, except for
/// those whose index does not fit in memory.
[[nodiscard]] Exhaustive measure_all(const sim::Problem& problem, std::span<const Contender> asked,
                                     const ExhaustiveOptions& options = {});

}  // namespace detp::validate
