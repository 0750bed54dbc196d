#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "detp/validate/bench/peer/embree_peer.hpp"
#include "referee.hpp"

/// Competitors on the same rays and discs, in turns.
namespace detp::validate {

/// One of ours, or Embree in one of its modes.
using Competitor = std::variant<Candidate, EmbreeMode>;

[[nodiscard]] inline bool is_ours(const Competitor& competitor) {
  return std::holds_alternative<Candidate>(competitor);
}

/// "sphere-tree", or "embree".
[[nodiscard]] std::string technique_of(const Competitor& competitor);

/// Its parameters for a reader, or Embree's mode.
[[nodiscard]] std::string parameters_of(const Competitor& competitor);

/// How one competitor did.
struct Finish {
  Competitor competitor;
  std::vector<double> seconds = {};  ///< of each run, from discs and rays in memory to irradiance in memory
  std::uint64_t hits = 0;            ///< found, over all discs
  std::uint64_t wrong_hits = 0;      ///< RightHits::wrong, the most of any run

  [[nodiscard]] double median_seconds() const;
};

struct RaceOptions {
  int repeats = 5;    ///< rounds, at most
  double enough = 2;  ///< seconds after which no round beyond the third is begun
  int finalists = 2;  ///< of each side, that run after the first round
  int threads = 1;
  std::stop_token stop = {};
};

struct Race {
  std::vector<Finish> finishes;  ///< of all that ran at least once, in the order given
  bool complete = false;         ///< all ran at least once
};

/// Runs all competitors in turn, round after round, so that a disturbance of the machine hits all alike. After the
/// first round only the fastest of each side go on: what a slower one would do more exactly changes nothing. Every
/// run's hits are compared with the right ones, outside its time.
///
/// Embree's threads are those of the peer given; they should be as many as the options say.
[[nodiscard]] Race race(const Job& job, const RightHits& right, const EmbreePeer& embree,
                        const std::vector<Competitor>& competitors, const RaceOptions& options);

}  // namespace detp::validate
