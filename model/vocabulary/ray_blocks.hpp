#pragma once

#include <cmath>

#include "engine.hpp"

namespace detp {

/// The rays as an engine searches them: block after block, all of one size except for a smaller last one.
struct RayBlocks {
  double whole = 0;  ///< number of blocks of `size` rays
  double size = 0;
  double last = 0;  ///< rays in the smaller last block; 0: there is none

  [[nodiscard]] double count() const { return whole + (last > 0 ? 1 : 0); }

  /// Expected number of blocks for which a list holds at least one ray. A list holds each ray independently, with the
  /// same probability. This probability differs from list to list as a gamma variable: `probability` is its mean,
  /// `spread` its variance over its squared mean.
  [[nodiscard]] double with_any(double probability, double spread = 0) const {
    const double hits = probability < 1 ? -std::log1p(-probability) : 1e300;
    const auto any = [&](double rays) {
      const double rate = rays * hits;
      return -std::expm1(spread > 1e-6 ? -std::log1p(spread * rate) / spread : -rate);
    };
    return whole * any(size) + (last > 0 ? any(last) : 0);
  }
};

/// The plain engine searches all rays in one block, the simd engine in blocks of rays_in_block.
[[nodiscard]] inline RayBlocks ray_blocks(double rays, double discs, Engine engine) {
  constexpr double many = 1e9;  // as far as the number of discs matters
  const auto size = static_cast<double>(rays_in_block(static_cast<std::size_t>(std::min(discs, many))));
  if (engine == Engine::plain || rays <= size) return {1, rays, 0};
  const double whole = std::floor(rays / size);
  const double last = rays - whole * size;
  return {whole, size, last < 1 ? 0 : last};
}

}  // namespace detp
