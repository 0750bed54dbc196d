#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/sim/base/radix_sort.hpp"
#include "part_results.hpp"

namespace detp::sim {

/// Discs in the order of the Morton curve, cut into parts of equal cost: 1 + d²/mean d² each, for reaching a disc and for its hits. Found from every k-th
/// disc if there are more than 2¹⁹: then parts differ by about one per cent.
class DiscCut {
 public:
  static constexpr std::uint64_t most_sampled = std::uint64_t{1} << 19;

  /// Reads all discs twice. At least one disc for each part. Throws as DiscSource::read.
  DiscCut(const DiscSource& discs, std::size_t parts, const std::stop_token& stop = {});

  /// The part of each of the discs, which have the numbers `first` and so on. Uses oneTBB's threads.
  void find_parts(std::span<const Disc> discs, std::uint64_t first, std::span<std::uint32_t> parts) const;

  /// Number of discs that a part is expected to have.
  [[nodiscard]] std::uint64_t expected(std::size_t part) const { return (cuts_[part + 1] - cuts_[part]) * stride_; }

  /// Cuts anew: the parts so far took so many seconds.
  void correct(std::span<const double> seconds);

 private:
  void cut();

  Box centres_;
  std::uint64_t stride_;
  std::vector<KeyedIndex> sampled_;  ///< on the curve; discs in one cell in the order of their numbers
  std::vector<float> costs_;         ///< of these
  std::vector<std::size_t> cuts_;    ///< where the parts begin in `sampled_`, and its end
  std::vector<KeyedIndex> begins_;   ///< of the parts but the first
};

}  // namespace detp::sim
