#pragma once

#include "detp/sim/ranks/ranks.hpp"
#include "ranked.hpp"

/// What a rank found, and sends to rank 0.
namespace detp::sim {

/// Besides arrays; trivially copyable.
struct PartOfOutcome {
  Counts<std::uint64_t> counts;
  Vectors vectors;
  Batches batches;
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

/// run_on_ranks with Share::discs, on any number of ranks. Each searches `each` parts of the discs one after another; default: as few as are expected to fit in memory,
/// twice as many if they do not.
[[nodiscard]] RankedOutcome run_on_shared_discs(const DiscSource& discs, const RaySource& source,
                                                const Valid<Candidate>& candidate, const StreamOptions& options,
                                                Ranks& ranks, std::optional<std::size_t> each = {});

/// Adds counts and hits, not `done`.
void add_found(const PartOfOutcome& part, Outcome& all);
/// Seconds and bytes become those of the slower and larger one.
void slow_down_to(const PartOfOutcome& part, StreamedOutcome& all);
/// Adds seconds of a later part of the same rank.
void add_times(const PartOfOutcome& later, PartOfOutcome& all);

/// Parts are cut anew if their imbalance is larger.
inline constexpr double most_imbalance = 0.15;

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
