#include <algorithm>
#include <numeric>

#include "ranked_rays.hpp"

namespace detp::sim {

CutOfRays::CutOfRays(const RaySource& source, PhotonBlocks blocks, int ranks) {
  const std::uint64_t count = blocks.of(source.photons() - 1) + 1;
  std::uint64_t first = source.first_ray_of(0);
  for (std::uint64_t block = 0; block < count; ++block) {
    const std::uint64_t next = block + 1 < count ? source.first_ray_of(blocks.first(block + 1)) : source.size();
    blocks_.push_back({block, first, next});
    first = next;
  }
  parts_ = cut(blocks_, std::vector<double>(static_cast<std::size_t>(ranks), 1));
  // Ranks without blocks have an empty range behind those before them.
  ShareOfRays end;
  std::uint64_t least = count;
  for (std::vector<ShareOfRays>& ranges : parts_) {
    if (ranges.empty()) ranges.push_back({end.last, end.last, end.next_block, end.next_block});
    end = ranges.back();
    least = std::min(least, end.next_block - end.block);
    heads_.push_back(end);
  }
  constexpr std::uint64_t least_blocks = 16;
  constexpr std::uint64_t heads = 8;
  has_rest_ = least >= least_blocks;
  if (!has_rest_) return;
  for (ShareOfRays& head : heads_) {
    head.next_block = head.block + (head.next_block - head.block) / heads;
    head.last = blocks_[head.next_block].first;
  }
}

std::span<const CutOfRays::Block> CutOfRays::blocks_of(const ShareOfRays& share) const {
  return std::span(blocks_).subspan(share.block, share.next_block - share.block);
}

void CutOfRays::correct(std::span<const double> seconds) {
  constexpr double least_seconds = 0.02;
  if (!has_rest_ || *std::ranges::min_element(seconds) < least_seconds) return;
  std::vector<double> each;
  for (std::size_t rank = 0; rank < heads_.size(); ++rank)
    each.push_back(seconds[rank] /
                   static_cast<double>(std::max<std::uint64_t>(1, heads_[rank].last - heads_[rank].first)));
  if (imbalance(each) <= most_imbalance) return;
  std::vector<Block> rest;
  for (std::size_t rank = 0; rank < heads_.size(); ++rank) {
    const ShareOfRays& whole = parts_[rank].front();
    const auto after = blocks_of({heads_[rank].last, whole.last, heads_[rank].next_block, whole.next_block});
    rest.insert(rest.end(), after.begin(), after.end());
  }
  std::vector<double> speeds;
  for (const double one : each) speeds.push_back(each.front() / one);
  Parts parts = cut(rest, speeds);
  for (std::size_t rank = 0; rank < heads_.size(); ++rank) {
    std::vector<ShareOfRays>& ranges = parts[rank];
    ShareOfRays head = heads_[rank];
    const auto next = std::ranges::find(ranges, head.next_block, &ShareOfRays::block);
    if (next != ranges.end()) {
      head.last = next->last;
      head.next_block = next->next_block;
      ranges.erase(next);
    }
    ranges.insert(std::ranges::lower_bound(ranges, head.block, {}, &ShareOfRays::block), head);
  }
  parts_ = std::move(parts);
}

/// Consecutive blocks for each rank, so that the largest number of rays over the rank's speed is as small as can be.
CutOfRays::Parts CutOfRays::cut(std::span<const Block> blocks, std::span<const double> speeds) {
  const auto fill = [&](double most, Parts* parts) {
    std::size_t block = 0;
    for (std::size_t rank = 0; rank < speeds.size(); ++rank) {
      double room = most * speeds[rank];
      for (; block < blocks.size(); ++block) {
        const Block& next = blocks[block];
        room -= static_cast<double>(next.last - next.first);
        if (room < 0) break;
        if (parts == nullptr) continue;
        std::vector<ShareOfRays>& ranges = (*parts)[rank];
        if (ranges.empty() || ranges.back().next_block != next.number)
          ranges.push_back({next.first, next.first, next.number, next.number});
        ranges.back().last = next.last;
        ranges.back().next_block = next.number + 1;
      }
    }
    return block == blocks.size();
  };
  double low = 0;
  double high = 0;
  for (const Block& block : blocks) high += static_cast<double>(block.last - block.first);
  high /= *std::ranges::min_element(speeds);
  constexpr double exact = 1e-9;
  while (high - low > std::max(0.25, exact * high)) {
    const double middle = low + (high - low) / 2;
    fill(middle, nullptr) ? high = middle : low = middle;
  }
  Parts parts(speeds.size());
  fill(high, &parts);
  return parts;
}

}  // namespace detp::sim
