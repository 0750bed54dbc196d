#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "geometry.hpp"

/// The Hilbert curve. It visits the same cells as the Morton curve (the paper: Lebesgue), but consecutive cells share a
/// face.
namespace detp::sim {

/// Place of a point's cell (curve_cell) on the curve: 48 bits, one octal digit per level, the largest cells first, as
/// in the Morton code. So the points of a cell of any level are consecutive, and consecutive cells of one level share a
/// face.
///
/// The curve enters a cell at one corner, visits the eight octants along a Gray code, and leaves at a corner that
/// differs along one axis. The cell's state is the first corner and this axis. The octant visited as number w has state
///
///     corner' = corner ^ rotated(start(w))      axis' = axis + 1 + turn(w)  (mod 3)
///
///   where  rotated(c)  the three bits of c, rotated left by axis + 1 places
///          start(w)    the corner at which octant w is entered, in the curve's own axes:
///                      g(2 ⌊(w-1)/2⌋), g the Gray code; 0 for w = 0
///          turn(w)     the axis along which the curve leaves octant w: number of trailing ones of w, or of w - 1 if w
///                      is even; 0 for w = 0
///
/// Along the Hilbert curve a sphere cache is rebuilt 0.76 to 0.89 times as often as along the Morton curve (Q 0.5 …
/// 0.8, a volume and two scenes of 10⁵ samples), a cache of one sphere 0.65 to 0.84 times as often (10⁶ samples). The
/// measurements are in sim/geometry/README.md.
///
/// Source     C. Hamilton, A. Rau-Chaplin: Compact Hilbert indices (2008), for three dimensions. The 24 states are
///            tabulated at compile time.
[[nodiscard]] std::uint64_t hilbert_code(const glm::dvec3& point, const Box& box);

/// Returns the points' indices, ordered along the Hilbert curve through the points' bounding box. Points of the same
/// cell keep their order. At most 2³² - 1 points. Throws Stopped if a stop was requested.
[[nodiscard]] std::vector<std::uint32_t> hilbert_order(std::span<const glm::dvec3> points,
                                                       const std::stop_token& stop = {});

}  // namespace detp::sim
