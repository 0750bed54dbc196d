#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "geometry.hpp"

/// The Hilbert curve: through the same cells as the Lebesgue curve, but from each to one that shares a face with it.
namespace detp::sim {

/// Place of a point's cell (curve_cell) on the curve, 48 bits: one octal digit a level, the largest cells first, as in
/// the Lebesgue code. So the points of a cell of any level are consecutive, and cells of one level, one after another,
/// share a face.
///
/// Within a cell the curve enters at one corner, visits the eight octants along a Gray code, and leaves at a corner
/// that differs along one axis. Which corner and which axis is the state; the octant visited as number w has the state
///
///     corner' = corner ^ rotated(start(w))      axis' = axis + 1 + turn(w)  (mod 3)
///
///   where  start(w)  the corner at which the w-th octant is entered, in the curve's own axes: g(2 ⌊(w-1)/2⌋), g the
///   Gray
///                    code; 0 for w = 0
///          turn(w)   the axis along which the curve leaves that octant: trailing ones of w, or of w - 1 for even w
///
/// A sphere cache is rebuilt 0.76 to 0.89 times as often along it as along the Lebesgue curve (Q 0.5 … 0.8, a volume
/// and two scenes of 10⁵ samples: sim/README.md, "Trees"); one sphere alone among 10⁶ samples 0.65 to 0.84 times.
///
/// Source     C. Hamilton, A. Rau-Chaplin: Compact Hilbert indices (2008), for three dimensions. The 24 states are
///            tabulated when this is compiled.
[[nodiscard]] std::uint64_t hilbert_code(const glm::dvec3& point, const Box& box);

/// Indices of the points in the order of the curve through their bounding box; points of the same cell keep their
/// order. At most 2³² - 1 points. Throws Stopped if a stop was requested.
[[nodiscard]] std::vector<std::uint32_t> hilbert_order(std::span<const glm::dvec3> points,
                                                       const std::stop_token& stop = {});

}  // namespace detp::sim
