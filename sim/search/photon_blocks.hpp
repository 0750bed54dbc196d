#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "detp/model/vocabulary/engine.hpp"

namespace detp::sim {

/// How photons are divided into blocks, whose sums are added apart (totals.hpp): block b has the photons b · size … (b + 1) · size - 1.
struct PhotonBlocks {
  int log2_size = 18;

  /// As many photons as a block of rays has rays, for so many discs: smaller blocks would cut blocks of rays. At least a
  /// sixteenth of the discs, because the end of a block costs some time for each disc, and memory grows with the logarithm of the
  /// number of blocks.
  [[nodiscard]] static PhotonBlocks for_discs(std::size_t discs) {
    return {std::countr_zero(std::bit_ceil(std::max(rays_in_block(discs), discs / 16)))};
  }

  [[nodiscard]] std::uint64_t of(std::uint64_t photon) const { return photon >> log2_size; }
  [[nodiscard]] std::uint64_t first(std::uint64_t block) const { return block << log2_size; }

  bool operator==(const PhotonBlocks&) const = default;
};

}  // namespace detp::sim
