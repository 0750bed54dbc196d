#pragma once

#include <optional>
#include <span>

#include "bench.hpp"

namespace detp::validate {

/// Summary of many races against Embree: ratios of Embree's median time to ours.
struct AgainstEmbree {
  int threads = 1;
  std::size_t races = 0;
  double geometric_mean = 0;
  double worst = 0;         ///< the smallest ratio
  std::size_t worst_entry;  ///< the entry that has the smallest ratio
};

/// Summary over the complete races with `threads` threads; nothing if there is none.
[[nodiscard]] std::optional<AgainstEmbree> against_embree(std::span<const BenchEntry> entries, int threads);

/// Whether all our techniques found the right hits in all races.
[[nodiscard]] bool do_own_hits_agree(std::span<const BenchEntry> entries);

/// Number of wrong hits, and of all hits, in all of Embree's runs.
struct WrongHits {
  std::uint64_t wrong = 0;
  std::uint64_t hits = 0;
};
[[nodiscard]] WrongHits embree_wrong_hits(std::span<const BenchEntry> entries);

}  // namespace detp::validate
