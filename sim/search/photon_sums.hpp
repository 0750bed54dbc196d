#pragma once

#include <glm/vec3.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "detp/model/vocabulary/engine.hpp"

namespace detp::sim {

/// u = 2^e, by which powers are multiplied before they are squared, so that squares neither overflow nor vanish: 1 unless the largest
/// power of a ray is beyond 2^256 or below 2^-256. Returns e. Powers of two change no digit of a result.
[[nodiscard]] inline int unit_exponent(double largest_power) {
  constexpr int usual = 256;
  constexpr int extreme = 640;  // the middle between 256 and 1024
  if (!(largest_power > 0)) return 0;
  const int exponent = std::ilogb(largest_power);
  return exponent > usual ? -extreme : exponent < -usual ? extreme : 0;
}

/// What the standard error of one disc's irradiance needs: sums over the photons that hit the disc. All rays of a photon's
/// path are one photon: they share its fate, so their powers on one disc are added before anything is squared.
struct PhotonSums {
  /// Σ (u x)² over complete photons of the block under way, x a photon's power on this disc, u the unit of its Totals: three sums, by
  /// the dominant axis of the photon's first ray that hits, each in the order of the photons
  glm::dvec3 squares{0.0};
  double open = 0;                   ///< power of the photon under way
  double largest = 0;                ///< largest power of one photon on this disc
  std::uint64_t photon = no_photon;  ///< number of the photon under way
  std::uint32_t axis = 0;            ///< of the photon under way
  std::uint32_t photons = 0;         ///< complete photons, of all blocks; does not grow beyond `most_photons`

  static constexpr std::uint64_t no_photon = std::numeric_limits<std::uint64_t>::max();
  static constexpr std::uint32_t most_photons = std::uint32_t{1} << 31;

  /// Adds a ray of a photon. Rays must come in the order of their numbers, so that those of a photon follow one another.
  void add(std::uint64_t number, int dominant_axis, double power, double unit) {
    if (number != photon) {
      close(unit);
      photon = number;
      axis = static_cast<std::uint32_t>(dominant_axis);
    }
    open += power;
  }

  /// Completes the photon under way.
  void close(double unit) {
    if (photon == no_photon) return;
    squares[static_cast<int>(axis)] += (unit * open) * (unit * open);
    largest = std::max(largest, open);
    add_photons(1);
    open = 0;
    photon = no_photon;
  }

  void add_photons(std::uint64_t count) {
    photons = static_cast<std::uint32_t>(std::min<std::uint64_t>(most_photons, photons + count));
  }
};

/// How photons are divided into blocks, whose sums are added apart (totals.hpp): block b has the photons b · size … (b + 1) · size - 1.
struct PhotonBlocks {
  int log2_size = 18;

  /// At least as many photons as a block of rays has rays, for so many discs: smaller blocks would cut blocks of rays. At least a sixteenth of the
  /// discs, because memory grows with the logarithm of the number of blocks. Sixteen for each disc, up to 2²⁰, because the end of a block
  /// costs some 20 ns for each disc; not more, because ranks share whole blocks.
  [[nodiscard]] static PhotonBlocks for_discs(std::size_t discs) {
    constexpr std::size_t many = std::size_t{1} << 20;
    return {std::countr_zero(std::bit_ceil(std::max({rays_in_block(discs), std::min(16 * discs, many), discs / 16})))};
  }

  [[nodiscard]] std::uint64_t of(std::uint64_t photon) const { return photon >> log2_size; }
  [[nodiscard]] std::uint64_t first(std::uint64_t block) const { return block << log2_size; }

  bool operator==(const PhotonBlocks&) const = default;
};

}  // namespace detp::sim
