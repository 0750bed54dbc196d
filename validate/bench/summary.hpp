#pragma once

#include <optional>
#include <span>

#include "bench.hpp"

namespace detp::validate {

/// Summary of many races: ratios of Embree's shortest median time to our shortest median time.
struct AgainstEmbree {
  int threads = 1;
  std::size_t races = 0;
  double geometric_mean = 0;
  double worst = 0;         ///< the smallest ratio
  std::size_t worst_entry;  ///< index of the entry with the smallest ratio
};

/// Whose times are compared with Embree's.
enum class Ours { best, choice };

/// Summary over the complete races with `threads` threads; nothing if there is none, or if our choice did not take part.
[[nodiscard]] std::optional<AgainstEmbree> against_embree(std::span<const BenchEntry> entries, int threads,
                                                          Ours ours = Ours::best);

/// The share of what our best technique gains on Embree that our choice gains: geometric mean over these races of the time
/// of the best over that of the choice, with choosing. 0 if there are none.
[[nodiscard]] double kept_by_choice(std::span<const BenchEntry> entries, int threads);

/// True if all our techniques found the right hits in all races.
[[nodiscard]] bool do_own_hits_agree(std::span<const BenchEntry> entries);

/// Embree's wrong hits and all its hits, summed over all of its modes in all races. A mode's runs in one race count as
/// one run: `wrong` is the largest number among them.
struct WrongHits {
  std::uint64_t wrong = 0;
  std::uint64_t hits = 0;
};
[[nodiscard]] WrongHits embree_wrong_hits(std::span<const BenchEntry> entries);

}  // namespace detp::validate
