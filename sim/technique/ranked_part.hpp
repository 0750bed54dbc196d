#pragma once

#include "detp/sim/ranks/ranks.hpp"
#include "ranked.hpp"

/// What a rank found, and sends to rank 0.
namespace detp::sim {

/// Besides arrays; trivially copyable.
struct PartOfOutcome {
  Counts<std::uint64_t> counts;
  Vectors vectors;
  HitBatches batches;
  Phases phases;
  std::uint64_t total_hits = 0;
  std::uint64_t done = 0;
  double read_seconds = 0;
  double check_seconds = 0;
  double bytes = 0;
  double seconds = 0;
  int stopped = 0;
};

/// `seconds`: that the rank needed.
[[nodiscard]] PartOfOutcome part_of(const StreamedOutcome& found, double seconds);

/// run_on_ranks with Share::discs, on several ranks.
[[nodiscard]] RankedOutcome run_on_shared_discs(std::span<const Disc> discs, const RaySource& source,
                                                const Valid<Candidate>& candidate, const StreamOptions& options,
                                                Ranks& ranks);

/// Adds counts and hits, not `done`; seconds become those of the slower one.
void add(const PartOfOutcome& part, RankedOutcome& ranked);

template <class T>
void send_array(Ranks& ranks, const std::vector<T>& values, int to) {
  ranks.send_one(values.size(), to);
  ranks.send_all(std::span<const T>(values), to);
}

template <class T>
[[nodiscard]] std::vector<T> receive_array(Ranks& ranks, int from) {
  std::vector<T> values(ranks.receive_one<std::size_t>(from));
  ranks.receive_all(std::span<T>(values), from);
  return values;
}

}  // namespace detp::sim
