#pragma once

#include <optional>
#include <span>

#include "bench.hpp"

namespace detp::validate {

/// Ours against Embree over many races, as ratios of medians: how many times as long Embree took.
struct AgainstEmbree {
  int threads = 1;
  std::size_t races = 0;
  double geometric_mean = 0;
  double worst = 0;         ///< the least ratio
  std::size_t worst_entry;  ///< whose
};

/// Over the complete races with that many threads; nothing where there is none.
[[nodiscard]] std::optional<AgainstEmbree> against_embree(std::span<const BenchEntry> entries, int threads);

/// Whether all of ours found the right hits, always.
[[nodiscard]] bool ours_agree(std::span<const BenchEntry> entries);

/// Of Embree's hits in all its runs, those that are wrong.
struct WrongHits {
  std::uint64_t wrong = 0;
  std::uint64_t hits = 0;
};
[[nodiscard]] WrongHits embree_wrong_hits(std::span<const BenchEntry> entries);

}  // namespace detp::validate
