#pragma once

#include <cstdint>

#include "detp/sim/scene/mesh.hpp"

namespace detp::sim::built_in {

/// A square of land around the origin. Smooth noise gives its height.
struct Ground {
  double side;       ///< length
  int cells;         ///< number along a side; each cell is cut into two triangles
  double relief;     ///< heights lie in [-relief / 2, relief / 2], a length
  double hill_size;  ///< distance between neighbouring hills and hollows, a length
  std::uint64_t seed;

  /// Height of the land at (x, z).
  [[nodiscard]] double height(double x, double z) const;
};

/// Adds the ground's triangles, which face up.
void add_ground(Mesh& mesh, const Ground& ground);

}  // namespace detp::sim::built_in
