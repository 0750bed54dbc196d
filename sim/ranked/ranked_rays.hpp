#pragma once

#include "ranked_part.hpp"

/// Ranks that share the rays of a search.
namespace detp::sim {

/// run_on_ranks with Share::rays, on several ranks.
[[nodiscard]] RankedOutcome run_on_shared_rays(std::span<const Disc> discs, const RaySource& source,
                                               const Valid<Candidate>& candidate, const StreamOptions& options,
                                               Ranks& ranks);

/// Rays in blocks of photons, cut into the parts of ranks.
class CutOfRays {
 public:
  /// Equal parts. Makes no rays, but may trace some photons.
  CutOfRays(const RaySource& source, PhotonBlocks blocks, int ranks);

  /// The ranges of each rank, in the order of their rays; at first one for each.
  using Parts = std::vector<std::vector<ShareOfRays>>;
  [[nodiscard]] const Parts& parts() const { return parts_; }
  /// What each rank searches first, before ranks are compared: an eighth of its part, or all if a part has fewer than 16 blocks.
  [[nodiscard]] const std::vector<ShareOfRays>& heads() const { return heads_; }
  /// Heads are not all.
  [[nodiscard]] bool has_rest() const { return has_rest_; }
  /// The ranks searched their heads in so many seconds. If the imbalance of the times for a ray is over 15 %, shares the rest in their inverse proportion.
  /// Times under 20 ms say too little.
  void correct(std::span<const double> seconds);

 private:
  struct Block {
    std::uint64_t number;
    std::uint64_t first;
    std::uint64_t last;
  };
  [[nodiscard]] static Parts cut(std::span<const Block> blocks, std::span<const double> speeds);
  [[nodiscard]] std::span<const Block> blocks_of(const ShareOfRays& share) const;

  std::vector<Block> blocks_;
  Parts parts_;
  std::vector<ShareOfRays> heads_;
  bool has_rest_ = false;
};

}  // namespace detp::sim
